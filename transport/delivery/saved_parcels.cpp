// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/saved_parcels.hpp"

#include <array>
#include <cassert>
#include <limits>

#include <sodium.h>

#include "transport/wire/packet_reader.hpp"
#include "transport/wire/packet_writer.hpp"

namespace warren::mesh {
namespace {

constexpr std::uint32_t kMagic = 0x504D'5257;  // "WRMP"
constexpr std::uint64_t kVersion = 1;
constexpr std::uint64_t kNumberMax = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kDigestBytes = 16;
using Digest = std::array<std::uint8_t, kDigestBytes>;

Digest digest_of(std::span<const std::uint8_t> body) {
  Digest digest{};
  crypto_generichash(digest.data(), digest.size(), body.data(), body.size(), nullptr, 0);
  return digest;
}

void write(PacketWriter& writer, const SavedOutgoing& outgoing) {
  writer.fixed(outgoing.stream, 8);
  writer.number(outgoing.next_number);
  writer.number(outgoing.parcels.size());
  for (const SavedOutgoing::Parcel& parcel : outgoing.parcels) {
    writer.number(parcel.number);
    writer.byte(static_cast<std::uint8_t>(parcel.priority));
    writer.number(parcel.bytes.size());
    writer.raw(parcel.bytes);
  }
}

void write(PacketWriter& writer, const SavedIncoming& incoming) {
  writer.byte(incoming.previous_stream ? 1 : 0);
  if (incoming.previous_stream) writer.fixed(*incoming.previous_stream, 8);
  writer.byte(incoming.stream ? 1 : 0);
  if (!incoming.stream) return;
  writer.fixed(incoming.stream->id, 8);
  writer.number(incoming.stream->finished_before);
  writer.number(incoming.stream->finished.size());
  for (const NumberRange& range : incoming.stream->finished) {
    writer.number(range.first);
    writer.number(range.end);
  }
}

std::optional<std::uint32_t> read_number(PacketReader& reader) {
  const auto number = reader.number(kNumberMax);
  if (!number) return std::nullopt;
  return static_cast<std::uint32_t>(*number);
}

std::optional<SavedOutgoing::Parcel> read_parcel(PacketReader& reader) {
  const auto number = read_number(reader);
  const auto priority = reader.fixed(1);
  const auto size = reader.number(ParcelFrame::kBytesMax);
  if (!number || !priority || !size || *priority > 1) return std::nullopt;
  const auto bytes = reader.raw(*size);
  if (!bytes) return std::nullopt;
  return SavedOutgoing::Parcel{
      *number, static_cast<ParcelClass>(*priority), {bytes->begin(), bytes->end()}};
}

std::optional<SavedOutgoing> read_outgoing(PacketReader& reader) {
  const auto stream = reader.fixed(8);
  const auto next_number = read_number(reader);
  const auto count = read_number(reader);
  if (!stream || !next_number || !count) return std::nullopt;
  SavedOutgoing outgoing{*stream, *next_number, {}};
  for (std::uint32_t i = 0; i < *count; ++i) {
    auto parcel = read_parcel(reader);
    if (!parcel || parcel->number >= outgoing.next_number) return std::nullopt;
    if (i > 0 && parcel->number <= outgoing.parcels.back().number) return std::nullopt;
    outgoing.parcels.push_back(std::move(*parcel));
  }
  return outgoing;
}

// An optional number of 8 bytes, behind a byte that says whether it is there. The outer optional:
// whether it could be read.
std::optional<std::optional<std::uint64_t>> read_optional_id(PacketReader& reader) {
  const auto present = reader.fixed(1);
  if (!present || *present > 1) return std::nullopt;
  if (*present == 0) return std::optional<std::uint64_t>{};
  const auto id = reader.fixed(8);
  if (!id) return std::nullopt;
  return id;
}

std::optional<SavedIncoming::Stream> read_stream(PacketReader& reader, std::uint64_t id) {
  const auto finished_before = read_number(reader);
  const auto count = reader.number(SavedIncoming::kRangesMax);
  if (!finished_before || !count) return std::nullopt;
  SavedIncoming::Stream stream{id, *finished_before, {}};
  std::uint64_t lowest = stream.finished_before;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto first = reader.number(kNumberMax);
    const auto end = reader.number(kNumberMax + 1);
    if (!first || !end || *first < lowest || *first >= *end) return std::nullopt;
    stream.finished.push_back({*first, *end});
    lowest = *end + 1;  // ranges do not touch
  }
  return stream;
}

std::optional<SavedIncoming> read_incoming(PacketReader& reader) {
  SavedIncoming incoming;
  const auto previous = read_optional_id(reader);
  if (!previous) return std::nullopt;
  incoming.previous_stream = *previous;
  const auto id = read_optional_id(reader);
  if (!id) return std::nullopt;
  if (!*id) return incoming;
  if (*id == incoming.previous_stream) return std::nullopt;
  incoming.stream = read_stream(reader, **id);
  if (!incoming.stream) return std::nullopt;
  return incoming;
}

}  // namespace

std::vector<std::uint8_t> encode(std::span<const SavedPeer> peers) {
  std::vector<std::uint8_t> bytes;
  PacketWriter writer(bytes);
  writer.fixed(kMagic, 4);
  writer.number(kVersion);
  writer.number(peers.size());
  for (const SavedPeer& peer : peers) {
    assert(&peer == &peers.front() || (&peer)[-1].member < peer.member);
    writer.fixed(peer.member.number, 4);
    write(writer, peer.outgoing);
    write(writer, peer.incoming);
  }
  writer.raw(digest_of(bytes));
  return bytes;
}

std::optional<std::vector<SavedPeer>> read_saved_parcels(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kDigestBytes) return std::nullopt;
  const auto body = bytes.first(bytes.size() - kDigestBytes);
  const Digest digest = digest_of(body);
  if (sodium_memcmp(digest.data(), bytes.last(kDigestBytes).data(), kDigestBytes) != 0)
    return std::nullopt;
  return read_saved_parcels_body(body);
}

std::optional<std::vector<SavedPeer>> read_saved_parcels_body(std::span<const std::uint8_t> body) {
  PacketReader reader(body);
  if (reader.fixed(4) != kMagic || reader.number(kNumberMax) != kVersion) return std::nullopt;
  const auto count = read_number(reader);
  if (!count) return std::nullopt;
  std::vector<SavedPeer> peers;
  for (std::uint32_t i = 0; i < *count; ++i) {
    const auto member = reader.fixed(4);
    if (!member) return std::nullopt;
    SavedPeer peer{MemberId{static_cast<std::uint32_t>(*member)}, {}, {}};
    if (i > 0 && !(peers.back().member < peer.member)) return std::nullopt;
    auto outgoing = read_outgoing(reader);
    if (!outgoing) return std::nullopt;
    auto incoming = read_incoming(reader);
    if (!incoming) return std::nullopt;
    peer.outgoing = std::move(*outgoing);
    peer.incoming = std::move(*incoming);
    peers.push_back(std::move(peer));
  }
  if (!reader.at_end()) return std::nullopt;
  return peers;
}

}  // namespace warren::mesh
