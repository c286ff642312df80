#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A second implementation of the mesh's packets, from docs/PROTOCOL.md alone: makes the golden
vectors and compares them with vectors.txt, and the page with both.

Usage: check_vectors.py [--print | --seeds tests/fuzz/corpus]"""
import hashlib
import pathlib
import struct
import sys

HERE = pathlib.Path(__file__).resolve().parent
PAGE = HERE.parents[2] / "docs" / "PROTOCOL.md"


# ChaCha20-Poly1305, RFC 8439.
def quarter(s, a, b, c, d):
    for x, y, z, turn in ((a, b, d, 16), (c, d, b, 12), (a, b, d, 8), (c, d, b, 7)):
        s[x] = s[x] + s[y] & 0xFFFFFFFF
        s[z] ^= s[x]
        s[z] = (s[z] << turn | s[z] >> 32 - turn) & 0xFFFFFFFF


def chacha_block(key, counter, nonce):
    start = list(struct.unpack("<16I", b"expand 32-byte k" + key + struct.pack("<I", counter) + nonce))
    s = start[:]
    for _ in range(10):
        for a, b, c, d in ((0, 4, 8, 12), (1, 5, 9, 13), (2, 6, 10, 14), (3, 7, 11, 15),
                           (0, 5, 10, 15), (1, 6, 11, 12), (2, 7, 8, 13), (3, 4, 9, 14)):
            quarter(s, a, b, c, d)
    return struct.pack("<16I", *(x + y & 0xFFFFFFFF for x, y in zip(s, start)))


def chacha(key, nonce, data):
    out = bytearray()
    for i in range(0, len(data), 64):
        block = chacha_block(key, 1 + i // 64, nonce)
        out += bytes(x ^ y for x, y in zip(data[i:i + 64], block))
    return bytes(out)


def poly1305(key, data):
    r = int.from_bytes(key[:16], "little") & 0x0FFFFFFC0FFFFFFC0FFFFFFC0FFFFFFF
    total = 0
    for i in range(0, len(data), 16):
        total = (total + int.from_bytes(data[i:i + 16] + b"\1", "little")) * r % (2**130 - 5)
    return (total + int.from_bytes(key[16:], "little") & 2**128 - 1).to_bytes(16, "little")


def aead(key, nonce, clear, content):
    sealed = chacha(key, nonce, content)
    pad = lambda data: data + bytes(-len(data) % 16)
    lengths = struct.pack("<QQ", len(clear), len(sealed))
    return sealed + poly1305(chacha_block(key, 0, nonce)[:32], pad(clear) + pad(sealed) + lengths)


# Keys and envelope.
def derive(fleet_key, label, *boots):
    data = label + b"".join(struct.pack("<Q", boot) for boot in boots)
    return hashlib.blake2b(data, key=fleet_key, digest_size=32).digest()


def seal(key, kind, sender, number, content):
    header = struct.pack("<BBQ", 0x10 | kind, 0, sender) + number.to_bytes(6, "little")
    nonce = bytes([kind]) + bytes(5) + number.to_bytes(6, "little")
    return header + aead(key, nonce, header, content)


# Contents.
def number(value):
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def beacon(member, uptime_s, period_ms, heard):
    out = number(member) + number(uptime_s) + number(period_ms)
    return out + b"".join(struct.pack("<IB", *one) for one in heard)


def hello(member, wants_answer):
    return bytes([2 if wants_answer else 1]) + number(member)


def ack(ranges, arrived_us, delay_us, pair_bytes, pair_us):
    out = b"\3" + number(len(ranges))
    below = None
    for first, end in ranges:
        out += number(end - 1 if below is None else below - end - 1) + number(end - first - 1)
        below = first
    return out + struct.pack("<I", arrived_us) + number(delay_us) + struct.pack("<Ii", pair_bytes, pair_us)


def ping(padding):
    return b"\4" + number(padding) + bytes(padding)


def urgent(count, data):
    return b"\5" + number(count) + number(len(data)) + data


def telemetry(key, version, data):
    return b"\6" + number(key) + number(version) + number(len(data)) + data


def parcel(stream, count, message, finished_before, total, offset, data):
    form = 0 if len(data) == total else 1 if offset + len(data) == total else 2
    age = count - finished_before
    out = bytes([0x80 | message << 6 | form << 4 | min(age, 15)]) + struct.pack("<Q", stream)
    out += number(count)
    if age >= 15:
        out += number(age - 15)
    if form != 0:
        out += (offset | total << 20).to_bytes(5, "little")
    if form != 1:
        out += number(len(data))
    return out + data


def parcel_state(stream, count, finished, have):
    out = bytes([8 if finished else 7]) + struct.pack("<Q", stream) + number(count)
    out += number(len(have))
    above = -1
    for first, end in have:
        out += number(first - above - 1) + number(end - first - 1)
        above = end
    return out


def fresh(data):
    return b"\x09" + data


def backlog(data):
    return b"\x0a" + data


def vectors():
    fleet = bytes(range(32))
    ann, bob = 0x0123456789ABCDEF, 0xFEDCBA9876543210
    ann_group = derive(fleet, b"warren mesh 1 group", ann)
    ann_bob = derive(fleet, b"warren mesh 1 pair", ann, bob)
    bob_ann = derive(fleet, b"warren mesh 1 pair", bob, ann)
    said = {
        "beacon": beacon(3, 300, 2000, [(0x76543210, 25)]),
        "hello": hello(3, True),
        "ack": ack([(995, 1000), (900, 990), (0, 1)], 0x12345678, 1500, 14280, -256),
        "ping": ping(4),
        "urgent": urgent(7, b"stop"),
        "telemetry": telemetry(300, 5, b"\1\2\3"),
        "parcel_whole": parcel(0x1122334455667788, 2, 1, 2, 5, 0, b"hello"),
        "parcel_tail": parcel(0x1122334455667788, 200, 0, 150, 1000000, 999998, b"!!"),
        "parcel_part": parcel(0x1122334455667788, 3, 1, 1, 300, 100, b"abc"),
        "parcel_asked": parcel(0x1122334455667788, 3, 1, 1, 300, 0, b""),
        "parcel_state": parcel_state(0x1122334455667788, 3, False, [(0, 100), (103, 200)]),
        "parcel_state_finished": parcel_state(0x1122334455667788, 2, True, []),
        "map_fresh": fresh(b"\1map"),
        "map_backlog": backlog(b"\1map"),
    }
    pair = said["hello"] + said["ack"] + said["urgent"] + said["map_fresh"]
    return {
        "fleet_key": fleet,
        "group_key": ann_group,
        "pair_key": ann_bob,
        "pair_key_back": bob_ann,
        **said,
        "packet_beacon": seal(ann_group, 0, ann, 1, said["beacon"]),
        "packet_pair": seal(ann_bob, 1, ann, 0x010203040506, pair),
        "packet_pair_back": seal(bob_ann, 1, bob, 0, b""),
        "packet_group": seal(ann_group, 2, ann, 1, said["map_backlog"]),
    }


def check_rfc_8439():
    """Section 2.8.2: the cipher itself, against its own vector."""
    text = (b"Ladies and Gentlemen of the class of '99: If I could offer you only one tip for "
            b"the future, sunscreen would be it.")
    sealed = aead(bytes(range(0x80, 0xA0)), bytes.fromhex("070000004041424344454647"),
                  bytes.fromhex("50515253c0c1c2c3c4c5c6c7"), text)
    assert sealed[-16:].hex() == "1ae10b594f09e26a7e902ecbd0600691", "ChaCha20-Poly1305 is wrong"


def write_seeds(corpus):
    for name, data in vectors().items():
        if "key" in name:
            continue
        folder = corpus / ("fuzz_mesh_beacon" if name == "beacon" else "fuzz_mesh_packet")
        folder.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    (corpus / "fuzz_mesh_beacon" / "lone").write_bytes(beacon(1, 0, 250, []))
    heard = [(boot * 0x01010101, boot) for boot in range(8)]
    (corpus / "fuzz_mesh_beacon" / "crowd").write_bytes(beacon(2**32 - 1, 86400, 65535, heard))


def main():
    check_rfc_8439()
    if "--seeds" in sys.argv:
        write_seeds(pathlib.Path(sys.argv[2]))
        return 0
    made = [f"{name} {data.hex()}" for name, data in vectors().items()]
    if "--print" in sys.argv:
        print("\n".join(made))
        return 0
    listed = (HERE / "vectors.txt").read_text().splitlines()
    page = PAGE.read_text().splitlines()
    faults = [f"vectors.txt, not made here: {line}" for line in listed if line not in made]
    faults += [f"made here, not in vectors.txt: {line}" for line in made if line not in listed]
    faults += [f"not on the page: {line}" for line in made if line not in page]
    print("\n".join(faults) or f"{len(made)} vectors agree")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
