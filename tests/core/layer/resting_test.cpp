// SPDX-License-Identifier: Apache-2.0
// Blocks at rest: packed, yet read, told and changed like others.
#include <algorithm>
#include <map>
#include <vector>

#include <doctest/doctest.h>

#include "core/layer/merge_map.hpp"
#include "core/layer/replica.hpp"
#include "tests/core/layer/mine_layer.hpp"

using namespace warren;

namespace {

constexpr LayerId kLayer{7, 1, 0x1234};
constexpr std::size_t kAll = 1 << 20;

std::map<BlockOrdinal, std::pair<Revision, CodeBlock>> content(const Replica& replica) {
  std::map<BlockOrdinal, std::pair<Revision, CodeBlock>> blocks;
  replica.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
    blocks[block] = {found.history.latest(), found.codes};
    return true;
  });
  return blocks;
}

std::vector<DiffPacket> encode_all(const Replica& sender, Revision from) {
  std::vector<DiffPacket> packets;
  KeyInterval keys;
  while (auto packet = sender.encode({keys, from})) {
    keys.first = packet->claim.keys.end;
    packets.push_back(std::move(*packet));
  }
  return packets;
}

}  // namespace

TEST_CASE("rest changes nothing that can be read, told, or hashed") {
  Replica layer = test::mine_layer(kLayer, 60);
  const auto before = content(layer);
  const Hash root = layer.digest().root();
  const auto regions = layer.digest().regions();
  std::vector<std::vector<LayerDigest::Entry>> hashes;
  for (const auto& region : regions) hashes.push_back(layer.digest_blocks(region.ordinal));

  CHECK(layer.rest({0}, kAll) == 0);
  CHECK(layer.regions_awake() == layer.regions());
  CHECK(layer.bytes_at_rest() == 0);
  const std::size_t rested = layer.rest(layer.holdings().at(0), kAll);
  CHECK(rested == layer.regions_by_change({}, kAll).size());
  CHECK(layer.regions() == rested);
  CHECK(layer.regions_awake() == 0);
  CHECK(layer.bytes_at_rest() > 0);
  CHECK(layer.bytes_at_rest() < layer.memory_bytes());
  CHECK(layer.rest(layer.holdings().at(0), kAll) == 0);

  CHECK(content(layer) == before);
  CHECK(layer.digest().root() == root);
  CHECK(layer.digest().regions() == regions);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    CHECK(layer.digest_blocks(regions[i].ordinal) == hashes[i]);
  }
  for (const auto& [block, expected] : before) {
    const LayerBlock* const found = layer.find(block);
    REQUIRE(found != nullptr);
    CHECK(found->codes == expected.second);
  }
  CHECK(layer.find(kOrdinalEnd - 1) == nullptr);

  Replica copy(kLayer, kDefaultResolution);
  for (const auto& packet : encode_all(layer, {})) copy.apply(kLayer, packet.bytes);
  CHECK(copy.digest().root() == root);
}

TEST_CASE("the longest unchanged regions are laid to rest first, and only so many at once") {
  Replica layer(kLayer, kDefaultResolution);
  const auto block = [](BlockOrdinal region, std::uint32_t place) {
    BlockCodes codes;
    codes.set(place, VoxelCode::free());
    return std::vector<CodedBlock>{{region << 9, CodeBlock(codes)}};
  };
  for (BlockOrdinal region = 0; region < 4; ++region) layer.publish(block(region, 1));
  layer.publish(block(0, 2));
  CHECK(layer.rest({2}, 1) == 1);
  CHECK(layer.rest({2}, kAll) == 0);
  CHECK(layer.rest({4}, kAll) == 2);
  CHECK(layer.rest({5}, kAll) == 1);
}

TEST_CASE("what changes wakes its region, and the digest follows") {
  Replica rested = test::mine_layer(kLayer, 20);
  Replica awake = test::mine_layer(kLayer, 20);
  rested.rest(rested.holdings().at(0), kAll);
  const auto blocks = content(awake);
  std::vector<CodedBlock> changes;
  for (const auto& [block, found] : blocks) {
    if (block % 7 == 0) changes.push_back({block, {}});
  }
  REQUIRE(!changes.empty());
  const Revision before = awake.holdings().at(0);
  for (Replica* const layer : {&rested, &awake}) layer->publish(changes);
  CHECK(content(rested) == content(awake));
  CHECK(rested.digest().root() == awake.digest().root());

  Replica copy = test::mine_layer(kLayer, 20);
  copy.rest(before, kAll);
  for (const auto& packet : encode_all(rested, before)) {
    CHECK(copy.apply(kLayer, packet.bytes) == ApplyResult::kApplied);
  }
  CHECK(copy.digest().root() == awake.digest().root());
}

TEST_CASE("blocks at rest can be forgotten, in part of a region too") {
  Replica rested = test::mine_layer(kLayer, 40);
  Replica awake = test::mine_layer(kLayer, 40);
  rested.rest(rested.holdings().at(0), kAll);
  const auto blocks = content(awake);
  auto place = blocks.begin();
  std::advance(place, blocks.size() / 3);
  const BlockOrdinal first = place->first;
  std::advance(place, blocks.size() / 3);
  const KeyInterval keys{first, place->first};
  CHECK(rested.forget(keys));
  CHECK(awake.forget(keys));
  CHECK(content(rested) == content(awake));
  CHECK(rested.digest().root() == awake.digest().root());
  CHECK(rested.digest().regions() == awake.digest().regions());
}

TEST_CASE("reading a whole layer at rest wakes nothing for good") {
  Replica layer = test::mine_layer(kLayer, 200);
  layer.rest(layer.holdings().at(0), kAll);
  const std::size_t unread = layer.memory_bytes();
  encode_all(layer, {});
  const std::size_t after_one = layer.memory_bytes();
  encode_all(layer, {});
  content(layer);
  CHECK(layer.memory_bytes() == after_one);
  layer.rest({0}, 1);
  CHECK(layer.memory_bytes() <= unread + 1024);
}

TEST_CASE("a visitor may read other blocks at rest, as many as it likes") {
  Replica layer = test::mine_layer(kLayer, 200);
  const auto before = content(layer);
  layer.rest(layer.holdings().at(0), kAll);
  const auto regions = layer.regions_by_change({}, kAll);
  REQUIRE(regions.size() > LayerBlocks::kRegionsReadMax);
  std::size_t visits = 0;
  layer.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
    if (visits++ % 100 == 0) {
      for (const KeyInterval& region : regions) layer.find(region.first);
    }
    return found.codes == before.at(block).second;
  });
  CHECK(visits == before.size());
}

TEST_CASE("a layer at rest merges as one awake, even where a block needs many of its regions") {
  const double fine_m = 0.0125;
  Replica layer = test::mine_layer(kLayer, 60);
  const auto merged = [&] {
    Eigen::Isometry3d askew(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
    askew.translation() = Eigen::Vector3d(0.03, 0.01, -0.02);
    MergeMap map({0.1});
    REQUIRE(map.add_layer(kLayer, layer, fine_m, askew) == MergeResult::kDone);
    std::vector<std::pair<std::uint64_t, VoxelCode>> voxels;
    map.for_each_known_voxel(KeyBox{}, [&](const VoxelKey& key, const MergedVoxel& voxel) {
      voxels.emplace_back(morton_of(key), voxel.code);
    });
    return voxels;
  };
  const auto awake = merged();
  CHECK(awake.size() > 100);
  REQUIRE(layer.rest(layer.holdings().at(0), kAll) > LayerBlocks::kRegionsReadMax);
  CHECK(merged() == awake);
}

TEST_CASE("a known voxel takes at most 2.5 bytes awake and 0.06 at rest") {
  Replica layer = test::mine_layer(kLayer, 200);
  const auto known = static_cast<double>(test::known_voxels(layer));
  const double awake = static_cast<double>(layer.memory_bytes()) / known;
  layer.rest(layer.holdings().at(0), kAll);
  const double at_rest = static_cast<double>(layer.memory_bytes()) / known;
  CAPTURE(awake);
  CAPTURE(at_rest);
  CHECK(awake <= 2.5);
  CHECK(at_rest <= 0.06);
}
