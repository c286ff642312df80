// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/layer_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "core/exchange/byte_fields.hpp"
#include "tests/core/exchange/temporary_folder.hpp"
#include "tests/core/layer/random_codes.hpp"

using namespace warren;
using namespace warren::test;

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr LayerId kLayer{7, 3, 0x123456789ABCDEF0};

void place(Replica& layer) {
  const Pose pose{{1.5, -2.0, 0.25},
                  Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()))};
  CHECK(layer.pose().update_origin({3, 7, pose}) == PoseResult::kTaken);
  CHECK(layer.pose().update_correction({1, 2, Pose{}}) == PoseResult::kTaken);
}

// A layer of one voxel of each kind in two regions.
Replica small_layer() {
  Replica layer(kLayer, *Resolution::from_metres(0.15));
  BlockCodes codes;
  codes.set(0, VoxelCode::free());
  codes.set(100, VoxelCode::occupied(3, true));
  layer.publish({{CodedBlock{5, CodeBlock(codes)}}});
  codes.set(200, VoxelCode::occupied(kNoCostData, false));
  layer.publish({{CodedBlock{5000, CodeBlock(codes)}}});
  place(layer);
  return layer;
}

// As a relay has it: emptied blocks, parts at various revisions, parts not held at all.
Replica random_layer(std::uint64_t seed) {
  Random random(seed);
  Replica origin(kLayer, *Resolution::from_micrometres(1000 + below(random, 1'000'000)));
  Replica copy(kLayer, origin.resolution());
  for (std::uint32_t tick = 1 + below(random, 8); tick > 0; --tick) {
    std::vector<CodedBlock> changes;
    std::set<BlockOrdinal> changed;
    for (std::uint32_t count = below(random, 6); count > 0; --count) {
      const BlockOrdinal block = chance(random, 50) ? below(random, 100) : random() % kOrdinalEnd;
      if (!changed.insert(block).second) continue;
      const auto codes = chance(random, 10) ? BlockCodes{} : random_codes(random, 5);
      changes.push_back({block, CodeBlock(codes)});
    }
    origin.publish(changes);
    const BlockOrdinal first = chance(random, 30) ? 0 : below(random, 90);
    const KeyInterval keys{first, chance(random, 50) ? kOrdinalEnd : first + 1 + below(random, 50)};
    const Revision from = copy.holdings().lowest(keys);
    if (const auto packet = origin.encode({keys, from})) copy.apply(kLayer, packet->bytes);
  }
  if (chance(random, 70)) place(copy);
  return copy;
}

bool same(const Replica& a, const Replica& b) {
  const auto blocks_of = [](const Replica& layer) {
    std::vector<std::tuple<BlockOrdinal, Revision, CodeBlock>> blocks;
    layer.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
      blocks.emplace_back(block, found.history.latest(), found.codes);
      return true;
    });
    return blocks;
  };
  return a.id() == b.id() && a.resolution() == b.resolution() && a.pose() == b.pose() &&
         a.holdings() == b.holdings() && a.digest().root() == b.digest().root() &&
         blocks_of(a) == blocks_of(b);
}

LayerFileError error_of(const Bytes& bytes) {
  const auto layer = decode_layer(bytes);
  REQUIRE_FALSE(layer);
  return layer.error();
}

// The content with its checksum, as one who forges a file would do.
Bytes sealed(Bytes content) {
  const Hash checksum = hash_of_bytes(content);
  content.insert(content.end(), checksum.begin(), checksum.end());
  return content;
}
Bytes unsealed(Bytes bytes) {
  bytes.erase(bytes.end() - static_cast<std::ptrdiff_t>(sizeof(Hash)), bytes.end());
  return bytes;
}

}  // namespace

TEST_CASE("a layer comes back from its file as it was, whole or partial") {
  CHECK(rc::check("round trip", [](std::uint64_t seed) {
    const Replica layer = random_layer(seed);
    const auto read = decode_layer(encode_layer(layer));
    RC_ASSERT(read.has_value());
    RC_ASSERT(same(*read, layer));
  }));
}

TEST_CASE("a layer with as many intervals as there may be comes back") {
  Replica origin(kLayer, kDefaultResolution);
  Replica copy(kLayer, kDefaultResolution);
  Random random(1);
  for (BlockOrdinal i = Holdings::kIntervalsMax; i > 0; --i) {
    std::vector<CodedBlock> changes;
    for (BlockOrdinal block = 0; block < 100; ++block) {
      changes.push_back({kOrdinalEnd / 2 + block, CodeBlock(random_codes(random))});
    }
    origin.publish(changes);
    const KeyInterval keys{i == 1 ? 0 : i * 512,
                           i == Holdings::kIntervalsMax ? kOrdinalEnd : (i + 1) * 512};
    for (KeyInterval left = keys; !left.empty();) {
      const auto packet = origin.encode({left, {}});
      REQUIRE(copy.apply(kLayer, packet->bytes) == ApplyResult::kApplied);
      left.first = packet->claim.keys.end;
    }
  }
  REQUIRE(copy.holdings().intervals().size() == Holdings::kIntervalsMax);
  const auto read = decode_layer(encode_layer(copy));
  REQUIRE(read);
  CHECK(same(*read, copy));
}

TEST_CASE("the bytes of a layer file are these") {
  const Bytes bytes = encode_layer(small_layer());
  std::uint64_t fnv1a = 0xCBF29CE484222325;
  for (const std::uint8_t byte : bytes) fnv1a = (fnv1a ^ byte) * 0x100000001B3;
  CHECK(bytes.size() == 249);
  CHECK(fnv1a == 12273845052727007325U);
  const Bytes head{'W', 'R', 'N',  'L',  'A',  'Y',  'R',  1,    7,    0,    0,    0,    3, 0,
                   0,   0,   0xF0, 0xDE, 0xBC, 0x9A, 0x78, 0x56, 0x34, 0x12, 0xF0, 0x49, 2, 0};
  CHECK(Bytes(bytes.begin(), bytes.begin() + 28) == head);
}

TEST_CASE("a layer file cut anywhere, or with a bit flipped anywhere, is refused") {
  Bytes bytes = encode_layer(small_layer());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    REQUIRE_FALSE(decode_layer(std::span(bytes).first(length)));
  }
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1U << bit % 8);
    REQUIRE_FALSE(decode_layer(bytes));
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1U << bit % 8);
  }
  CHECK(decode_layer(bytes));
}

TEST_CASE("forged files with a right checksum are read in bounds") {
  Bytes content = unsealed(encode_layer(small_layer()));
  for (std::size_t length = 8; length < content.size(); ++length) {
    REQUIRE_FALSE(decode_layer(
        sealed(Bytes(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(length)))));
  }
  std::set<LayerFileError> met;
  for (std::size_t bit = 0; bit < content.size() * 8; ++bit) {
    content[bit / 8] = static_cast<std::uint8_t>(content[bit / 8] ^ 1U << bit % 8);
    const auto layer = decode_layer(sealed(content));
    if (!layer) met.insert(layer.error());
    content[bit / 8] = static_cast<std::uint8_t>(content[bit / 8] ^ 1U << bit % 8);
  }
  CHECK(met == std::set{LayerFileError::kNotALayer, LayerFileError::kUnknownVersion,
                        LayerFileError::kMalformed, LayerFileError::kBadPose,
                        LayerFileError::kUnknownPacketVersion, LayerFileError::kDigestMismatch});
  Random random(1);
  for (int round = 0; round < 2000; ++round) {
    Bytes noise(content.begin(), content.begin() + 28 + below(random, 140));
    for (std::uint32_t count = below(random, 3000); count > 0; --count) {
      noise.push_back(static_cast<std::uint8_t>(random()));
    }
    CHECK_FALSE(decode_layer(sealed(noise)));
  }
}

TEST_CASE("each reason to refuse a layer file has its name") {
  const Bytes bytes = encode_layer(small_layer());
  CHECK(error_of({}) == LayerFileError::kNotALayer);
  CHECK(error_of({'P', 'K', 3, 4, 0, 0, 0, 0, 0, 0}) == LayerFileError::kNotALayer);
  Bytes later = unsealed(bytes);
  ++later[7];
  CHECK(error_of(sealed(later)) == LayerFileError::kUnknownVersion);
  Bytes longer = bytes;
  longer.push_back(0);
  CHECK(error_of(longer) == LayerFileError::kCorrupt);
  Bytes other_root = unsealed(bytes);
  other_root.back() = static_cast<std::uint8_t>(other_root.back() ^ 1);
  CHECK(error_of(sealed(other_root)) == LayerFileError::kDigestMismatch);
}

TEST_CASE("a pose that is not finite, no rotation or too far off is named as what is wrong") {
  constexpr std::size_t kOriginX = 36;  // after magic, version, id, resolution, revision, writer
  constexpr std::size_t kOriginQw = kOriginX + 6 * 8;
  constexpr std::size_t kCorrectionX = kOriginX + 64;
  const auto with = [](std::size_t at, double number) {
    Bytes content = unsealed(encode_layer(small_layer()));
    const auto bits = std::bit_cast<std::uint64_t>(number);
    for (std::size_t i = 0; i < 8; ++i) content[at + i] = static_cast<std::uint8_t>(bits >> 8 * i);
    return sealed(content);
  };
  CHECK(decode_layer(with(kOriginX, 1e8)).has_value());
  CHECK(error_of(with(kOriginX, 1.001e8)) == LayerFileError::kBadPose);
  CHECK(error_of(with(kOriginX, 1e300)) == LayerFileError::kBadPose);
  CHECK(error_of(with(kOriginX, std::nan(""))) == LayerFileError::kBadPose);
  CHECK(error_of(with(kOriginQw, std::numeric_limits<double>::infinity())) ==
        LayerFileError::kBadPose);
  CHECK(error_of(with(kOriginQw, 9.0)) == LayerFileError::kBadPose);
  CHECK(error_of(with(kCorrectionX, -2e9)) == LayerFileError::kBadPose);
  const TemporaryFolder folder;
  const Bytes far = with(kOriginX, 2e9);
  folder.write("far.layer", std::string(far.begin(), far.end()));
  CHECK(read_layer(folder / "far.layer").error().find("far.layer: its pose") != std::string::npos);
}

TEST_CASE("a layer file is written whole, and errors name the file") {
  const TemporaryFolder folder;
  const Replica layer = small_layer();
  REQUIRE(write_layer(layer, folder / "a.layer"));
  CHECK(folder.files() == 1);
  const auto read = read_layer(folder / "a.layer");
  REQUIRE(read);
  CHECK(same(*read, layer));
  CHECK_FALSE(write_layer(layer, folder / "none/a.layer"));
  CHECK(read_layer(folder / "b.layer").error().find("b.layer: no such file") != std::string::npos);
  folder.write("c.layer", "WRNLAYR");
  CHECK(read_layer(folder / "c.layer").error().find("c.layer: this is no layer") !=
        std::string::npos);
}
