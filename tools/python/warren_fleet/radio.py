# SPDX-License-Identifier: Apache-2.0
"""Traces of the simulated world's radio, made worse: lossy, with blackouts, with a hermit; and healed
at the end."""
import csv
import dataclasses


@dataclasses.dataclass
class Row:
    time_s: float
    sender: str
    receiver: str
    loss: float
    rate_bit_s: float


@dataclasses.dataclass
class Blackout:
    from_s: float
    until_s: float
    node: str | None = None  # None: everybody's


def read(path):
    with open(path, newline="") as file:
        return [Row(float(row["time_s"]), row["from"], row["to"], float(row["loss"]),
                    float(row["rate_bit_s"])) for row in csv.DictReader(file)]


def write(path, rows):
    with open(path, "w") as file:
        file.write("time_s,from,to,loss,rate_bit_s\n")
        for row in rows:
            file.write(f"{row.time_s:.3f},{row.sender},{row.receiver},{row.loss:.6f},"
                       f"{row.rate_bit_s:.0f}\n")


def between(row, one, other):
    return {row.sender, row.receiver} == {one, other}


def _is_silent(row, blackouts):
    return any(each.from_s <= row.time_s < each.until_s
               and each.node in (None, row.sender, row.receiver) for each in blackouts)


def worsened(rows, *, delay_s, loss, blackouts, hermit=None):
    """The same `delay_s` later (its first second holds until then), every packet that would have
    arrived lost with `loss` besides. `hermit`: (node, the only one that it ever meets)."""
    first_s = min(row.time_s for row in rows)
    for row in rows:
        time_s = row.time_s + delay_s if row.time_s > first_s else 0.0
        moved = dataclasses.replace(row, time_s=time_s, loss=1.0 - (1.0 - row.loss) * (1.0 - loss))
        if row.rate_bit_s <= 0.0 or _is_silent(moved, blackouts) or _is_kept_apart(row, hermit):
            moved.loss = 1.0
        yield moved


def healed(rows, *, at_s, loss, rate_bit_s, hermit=None):
    """What those that follow `rows` from `at_s` on: everybody hears everybody, but the hermit."""
    first_s = min(row.time_s for row in rows)
    for row in rows:
        if row.time_s > first_s:
            return
        yield Row(at_s, row.sender, row.receiver, 1.0 if _is_kept_apart(row, hermit) else loss,
                  rate_bit_s)


def _is_kept_apart(row, hermit):
    return (hermit is not None and hermit[0] in (row.sender, row.receiver)
            and not between(row, *hermit))
