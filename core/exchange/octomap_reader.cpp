// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/octomap_reader.hpp"

#include <bit>
#include <charconv>
#include <new>
#include <optional>
#include <span>
#include <utility>

#include "core/exchange/byte_fields.hpp"
#include "core/exchange/file_bytes.hpp"

namespace warren {
namespace {

constexpr int kRootLevel = 16;
constexpr int kBlockLevel = 3;

struct Header {
  bool is_binary = false;
  Resolution resolution;
  bool is_empty = false;
  std::size_t bytes = 0;
};

class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  std::optional<std::string_view> next() {
    const std::size_t end = text_.find('\n', used_);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view line = text_.substr(used_, end - used_);
    used_ = end + 1;
    ++number_;
    return line;
  }
  std::size_t number() const { return number_; }
  std::size_t used() const { return used_; }

 private:
  std::string_view text_;
  std::size_t used_ = 0;
  std::size_t number_ = 0;
};

// What follows "name " on its line.
std::optional<std::string_view> value_of(std::string_view line, std::string_view name) {
  if (line.size() <= name.size() || line.substr(0, name.size()) != name) return std::nullopt;
  if (line[name.size()] != ' ') return std::nullopt;
  return line.substr(name.size() + 1);
}

std::optional<Resolution> resolution_of(std::string_view text) {
  double metres = 0.0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, metres);
  if (read.ec != std::errc{} || read.ptr != end) return std::nullopt;
  return Resolution::from_metres(metres);
}

Decoded<Header> read_header_lines(std::string_view bytes) {
  constexpr std::size_t kLinesMax = 100;
  Lines lines(bytes);
  const auto first = lines.next();
  Header header;
  header.is_binary = first == "# Octomap OcTree binary file";
  if (!header.is_binary && first != "# Octomap OcTree file") {
    return decode_error(1, "not the first line of an OctoMap tree");
  }
  bool is_octree = false;
  std::optional<Resolution> resolution;
  for (auto line = lines.next(); line && lines.number() < kLinesMax; line = lines.next()) {
    if (line == "data") {
      if (!is_octree) return decode_error(0, "no line \"id OcTree\": other trees are not read");
      if (!resolution) return decode_error(0, "no line with \"res\", 0.001 to 10 m");
      header.resolution = *resolution;
      header.bytes = lines.used();
      return header;
    }
    if (const auto id = value_of(*line, "id")) is_octree = *id == "OcTree";
    if (const auto size = value_of(*line, "size")) header.is_empty = *size == "0";
    if (const auto text = value_of(*line, "res")) resolution = resolution_of(*text);
  }
  return decode_error(lines.number(), "the header has no line \"data\"");
}

// Leaves, which come in Morton order, as blocks.
class BlockCollector {
 public:
  // False if there are too many blocks.
  bool add(std::uint64_t morton, int level, VoxelCode code) {
    if (level >= kBlockLevel) return add_blocks(morton >> 9, level, code);
    if (blocks_.empty() || blocks_.back().block != morton >> 9) {
      close();
      if (blocks_.size() == kOctomapBlocksMax) return false;
      blocks_.push_back({morton >> 9, {}});
      is_open_ = true;
    }
    const auto first = static_cast<std::uint32_t>(morton & (kVoxelsPerBlock - 1));
    for (std::uint32_t place = first; place < first + (1U << 3 * level); ++place) {
      open_.set(place, code);
    }
    return true;
  }
  std::vector<CodedBlock> take() {
    close();
    return std::move(blocks_);
  }

 private:
  bool add_blocks(BlockOrdinal first, int level, VoxelCode code) {
    const std::uint64_t count = std::uint64_t{1} << 3 * (level - kBlockLevel);
    if (count > kOctomapBlocksMax - blocks_.size()) return false;
    close();
    BlockCodes codes;
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) codes.set(place, code);
    const CodeBlock uniform(codes);
    for (std::uint64_t i = 0; i < count; ++i) blocks_.push_back({first + i, uniform});
    return true;
  }
  void close() {
    if (is_open_) blocks_.back().codes = CodeBlock(open_);
    open_ = {};
    is_open_ = false;
  }

  std::vector<CodedBlock> blocks_;
  BlockCodes open_;  // of the last block, which is still being filled
  bool is_open_ = false;
};

// Walks the nodes as they follow one another, parents first. A tree has 16 levels, so deeper ones
// are refused and recursion is bounded.
class NodeWalk {
 public:
  NodeWalk(std::span<const std::uint8_t> bytes, BlockCollector& blocks)
      : in_(bytes), blocks_(blocks) {}

  // Two bits per child: 0 unknown, 1 free, 2 occupied, 3 with children of its own. The first of
  // a pair is the lower bit; children that have children follow after all eight.
  bool walk_states(std::uint64_t morton, int level) {
    const auto children = in_.number<std::uint16_t>();
    if (!in_.complete() || level <= 0) return fail("a tree of more than 16 levels, or cut short");
    for (std::uint32_t child = 0; child < 8; ++child) {
      const std::uint32_t state = children >> 2 * child & 3;
      const std::uint64_t child_morton = morton | std::uint64_t{child} << 3 * (level - 1);
      if (state == 3 && !walk_states(child_morton, level - 1)) return false;
      if (state != 1 && state != 2) continue;
      if (!add(child_morton, level - 1, state == 2)) return false;
    }
    return true;
  }

  // Each node is its log-odds, float32, and one bit per child that follows.
  bool walk_log_odds(std::uint64_t morton, int level) {
    const auto log_odds = std::bit_cast<float>(in_.number<std::uint32_t>());
    const auto children = in_.number<std::uint8_t>();
    if (!in_.complete()) return fail("the tree is cut short");
    if (children == 0) return add(morton, level, log_odds >= 0.0F);
    if (level <= 0) return fail("a tree of more than 16 levels");
    for (std::uint32_t child = 0; child < 8; ++child) {
      if ((children >> child & 1) == 0) continue;
      if (!walk_log_odds(morton | std::uint64_t{child} << 3 * (level - 1), level - 1)) return false;
    }
    return true;
  }

  bool finish() { return in_.left() == 0 || fail("bytes follow the tree"); }
  const char* error() const { return error_; }

 private:
  bool add(std::uint64_t morton, int level, bool occupied) {
    const VoxelCode code = occupied ? VoxelCode::occupied(kNoCostData, false) : VoxelCode::free();
    return blocks_.add(morton, level, code) || fail("the tree has more blocks than are read");
  }
  bool fail(const char* why) {
    error_ = why;
    return false;
  }

  ByteReader in_;
  BlockCollector& blocks_;
  const char* error_ = "";
};

LayerId layer_id_of(std::string_view bytes, std::uint32_t origin) {
  const Hash hash =
      hash_of_bytes({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  return {origin, 1, ByteReader(hash).number<std::uint64_t>()};
}

}  // namespace

Decoded<OctomapTree> decode_octomap(std::string_view bytes) {
  const auto header = read_header_lines(bytes);
  if (!header) return tl::make_unexpected(header.error());
  if (header->is_empty) return OctomapTree{header->resolution, {}};
  const std::string_view data = bytes.substr(header->bytes);
  BlockCollector blocks;
  NodeWalk walk({reinterpret_cast<const std::uint8_t*>(data.data()), data.size()}, blocks);
  const bool whole =
      (header->is_binary ? walk.walk_states(0, kRootLevel) : walk.walk_log_odds(0, kRootLevel)) &&
      walk.finish();
  if (!whole) return decode_error(0, walk.error());
  return OctomapTree{header->resolution, blocks.take()};
}

tl::expected<Replica, std::string> read_octomap(const std::filesystem::path& file,
                                                std::uint32_t origin) {
  const auto bytes = read_file_bytes(file, kOctomapFileBytesMax);
  if (!bytes) return tl::make_unexpected(bytes.error());
  try {
    const auto tree = decode_octomap(*bytes);
    if (!tree) return tl::make_unexpected(tree.error().located(file.string()));
    Replica replica(layer_id_of(*bytes, origin), tree->resolution);
    replica.publish(tree->blocks);
    return replica;
  } catch (const std::bad_alloc&) {
    return tl::make_unexpected(file.string() + ": not enough memory for its voxels");
  }
}

}  // namespace warren
