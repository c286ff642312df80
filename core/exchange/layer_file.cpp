// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/layer_file.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <new>
#include <optional>
#include <utility>

#include "core/exchange/byte_fields.hpp"
#include "core/exchange/file_bytes.hpp"

namespace warren {
namespace {

constexpr std::array<std::uint8_t, 7> kMagic = {'W', 'R', 'N', 'L', 'A', 'Y', 'R'};

void add_pose(ByteWriter& out, const WrittenPose& written) {
  out.add(written.revision);
  out.add(written.writer);
  std::for_each_n(written.pose.translation.data(), 3, [&](double number) { out.add(number); });
  std::for_each_n(written.pose.rotation.coeffs().data(), 4, [&](double n) { out.add(n); });
}

WrittenPose read_pose(ByteReader& in) {
  WrittenPose written;
  written.revision = in.number<std::uint32_t>();
  written.writer = in.number<std::uint32_t>();
  std::for_each_n(written.pose.translation.data(), 3, [&](double& number) { number = in.real(); });
  std::for_each_n(written.pose.rotation.coeffs().data(), 4, [&](double& n) { n = in.real(); });
  return written;
}

// Such a pose is the identity, or the file is malformed.
bool is_unwritten(const WrittenPose& written) { return written == WrittenPose{}; }

std::optional<LayerFileError> take_poses(LayerPose& pose, const WrittenPose& origin,
                                         const WrittenPose& correction) {
  const std::array results = {
      is_unwritten(origin) ? PoseResult::kTaken : pose.update_origin(origin),
      is_unwritten(correction) ? PoseResult::kTaken : pose.update_correction(correction)};
  for (const PoseResult result : results) {
    if (result == PoseResult::kNotRigid) return LayerFileError::kBadPose;
    if (result != PoseResult::kTaken) return LayerFileError::kMalformed;
  }
  return std::nullopt;
}

void add_packets(ByteWriter& out, const Replica& replica) {
  for_each_packet(replica, {{}, {}, kLayerFilePacketBytesMax}, [&](const DiffPacket& packet) {
    out.add(static_cast<std::uint32_t>(packet.bytes.size()));
    out.add(packet.bytes);
    return true;
  });
  out.add(std::uint32_t{0});
}

// What packets for one who held nothing tell, one after the other in key order.
class PacketSequence {
 public:
  std::optional<LayerFileError> add(std::span<const std::uint8_t> packet) {
    const auto header = read_header(packet);
    if (!header) return error_of(header.error());
    const Claim& claim = header->claim;
    if (claim.from != Revision{} || claim.keys.first < end_) return LayerFileError::kMalformed;
    const auto diffs = read_blocks(*header, packet);
    if (!diffs) return error_of(diffs.error());
    if (diffs->size() > kLayerFileBlocksMax - blocks_.size()) return LayerFileError::kTooLarge;
    for (const BlockDiff& diff : *diffs) {
      blocks_.push_back({diff.block, diff.changed_at, CodeBlock(diff.codes)});
    }
    if (end_ < claim.keys.first) append({end_, {}});
    append({claim.keys.first, claim.to});
    end_ = claim.keys.end;
    if (intervals_.size() > Holdings::kIntervalsMax) return LayerFileError::kMalformed;
    return std::nullopt;
  }

  // Nothing if they are more than a replica can have.
  std::optional<Holdings> holdings() {
    if (end_ < kOrdinalEnd) append({end_, {}});
    return Holdings::from_intervals(intervals_);
  }
  std::span<const StoredBlock> blocks() const { return blocks_; }

 private:
  static LayerFileError error_of(PacketError error) {
    return error == PacketError::kUnknownVersion ? LayerFileError::kUnknownPacketVersion
                                                 : LayerFileError::kMalformed;
  }

  void append(const Holdings::Interval& interval) {
    if (intervals_.empty() || intervals_.back().held != interval.held) {
      intervals_.push_back(interval);
    }
  }

  std::vector<StoredBlock> blocks_;
  std::vector<Holdings::Interval> intervals_;
  BlockOrdinal end_ = 0;
};

tl::expected<Replica, LayerFileError> read_content(ByteReader in) {
  const LayerId id{in.number<std::uint32_t>(), in.number<std::uint32_t>(),
                   in.number<std::uint64_t>()};
  const auto resolution = Resolution::from_micrometres(in.number<std::uint32_t>());
  const WrittenPose origin = read_pose(in);
  const WrittenPose correction = read_pose(in);
  LayerPose pose;
  if (!in.complete() || !resolution) return tl::unexpected(LayerFileError::kMalformed);
  if (const auto error = take_poses(pose, origin, correction)) return tl::unexpected(*error);
  PacketSequence packets;
  while (const auto size = in.number<std::uint32_t>()) {
    if (size > kLayerFilePacketBytesMax) return tl::unexpected(LayerFileError::kMalformed);
    if (const auto error = packets.add(in.bytes(size))) return tl::unexpected(*error);
  }
  Hash root{};
  const auto root_bytes = in.bytes(root.size());
  const auto holdings = packets.holdings();
  if (!in.complete() || in.left() != 0 || !holdings) {
    return tl::unexpected(LayerFileError::kMalformed);
  }
  std::copy(root_bytes.begin(), root_bytes.end(), root.begin());
  Replica replica(id, *resolution, *holdings, packets.blocks());
  replica.pose() = pose;
  if (replica.digest().root() != root) return tl::unexpected(LayerFileError::kDigestMismatch);
  return replica;
}

WriteResult write_bytes(std::span<const std::uint8_t> bytes, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) return tl::make_unexpected(std::string("the disk refused the data"));
  return {};
}

}  // namespace

const char* text_of(LayerFileError error) {
  switch (error) {
    case LayerFileError::kNotALayer:
      return "this is no layer file";
    case LayerFileError::kUnknownVersion:
      return "written in a later version of the format";
    case LayerFileError::kCorrupt:
      return "cut short or altered: its checksum is wrong";
    case LayerFileError::kMalformed:
      return "no writer of layers makes such bytes";
    case LayerFileError::kBadPose:
      return "its pose is not finite, no rotation, or over 100000 km off";
    case LayerFileError::kUnknownPacketVersion:
      return "holds diff packets of a later version";
    case LayerFileError::kTooLarge:
      return "holds more blocks than are read";
    case LayerFileError::kDigestMismatch:
      break;
  }
  return "its content is not the one of its digest";
}

std::vector<std::uint8_t> encode_layer(const Replica& replica) {
  ByteWriter out;
  out.add(kMagic);
  out.add(kLayerFileVersion);
  out.add(replica.id().origin);
  out.add(replica.id().number);
  out.add(replica.id().incarnation);
  out.add(replica.resolution().micrometres());
  add_pose(out, replica.pose().origin());
  add_pose(out, replica.pose().correction());
  add_packets(out, replica);
  out.add(replica.digest().root());
  out.add(hash_of_bytes(out.bytes()));
  return out.take();
}

tl::expected<Replica, LayerFileError> decode_layer(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kLayerFileBytesMax) return tl::unexpected(LayerFileError::kTooLarge);
  if (bytes.size() < kMagic.size() + 1 ||
      !std::equal(kMagic.begin(), kMagic.end(), bytes.begin())) {
    return tl::unexpected(LayerFileError::kNotALayer);
  }
  if (bytes[kMagic.size()] != kLayerFileVersion) {
    return tl::unexpected(LayerFileError::kUnknownVersion);
  }
  const auto sealed = bytes.first(bytes.size() - std::min(bytes.size(), sizeof(Hash)));
  const auto checksum = bytes.subspan(sealed.size());
  const Hash expected = hash_of_bytes(sealed);
  if (!std::equal(checksum.begin(), checksum.end(), expected.begin(), expected.end())) {
    return tl::unexpected(LayerFileError::kCorrupt);
  }
  const std::size_t begin = kMagic.size() + 1;
  if (sealed.size() < begin) return tl::unexpected(LayerFileError::kCorrupt);
  return read_content(ByteReader(sealed.subspan(begin)));
}

WriteResult write_encoded_layer(std::span<const std::uint8_t> bytes,
                                const std::filesystem::path& file) {
  const auto written = write_atomically(
      file, [&](const std::filesystem::path& temporary) { return write_bytes(bytes, temporary); });
  if (!written) return tl::make_unexpected(written.error());
  return {};
}

WriteResult write_layer(const Replica& replica, const std::filesystem::path& file) {
  return write_encoded_layer(encode_layer(replica), file);
}

tl::expected<Replica, std::string> read_layer(const std::filesystem::path& file) {
  const auto content = read_file_bytes(file, kLayerFileBytesMax);
  if (!content) return tl::make_unexpected(content.error());
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(content->data()),
                                            content->size());
  try {
    auto replica = decode_layer(bytes);
    if (!replica) return tl::make_unexpected(file.string() + ": " + text_of(replica.error()));
    return std::move(*replica);
  } catch (const std::bad_alloc&) {
    return tl::make_unexpected(file.string() + ": not enough memory for its blocks");
  }
}

}  // namespace warren
