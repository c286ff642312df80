// SPDX-License-Identifier: Apache-2.0
#include "core/layer/publisher.hpp"

#include <algorithm>
#include <optional>

#include <doctest/doctest.h>

#include "core/layer/replica.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;

namespace {

// A floor plane of costs under whatever was hit.
void add_costs(SelfMap& map, const test::SimulatedScan& scan) {
  std::vector<VoxelCost> costs;
  for (const Point3f& point : scan.points_layer) {
    const auto key = map.lattice().key_of(point);
    if (!key) continue;
    const float cost = 0.05F * static_cast<float>(key->x & 15);
    costs.push_back({*key, cost, 1.0F});
  }
  const auto by_key = [](const VoxelCost& a, const VoxelCost& b) { return a.key < b.key; };
  const auto same_key = [](const VoxelCost& a, const VoxelCost& b) { return a.key == b.key; };
  std::sort(costs.begin(), costs.end(), by_key);
  costs.erase(std::unique(costs.begin(), costs.end(), same_key), costs.end());
  map.fuse_costs(costs);
}

VoxelCode published_code(const Replica& layer, const VoxelKey& key) {
  const LayerBlock* const block = layer.find(ordinal_of(block_of(key)));
  return block != nullptr ? block->codes.at(morton9(key.x, key.y, key.z)) : VoxelCode{};
}

void check_published(const SelfMap& map, const Replica& layer) {
  std::uint64_t known = 0;
  map.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState state, float) {
    const VoxelCode code = published_code(layer, key);
    REQUIRE(code.state() == state);
    const bool occupied = state == VoxelState::kOccupied;
    REQUIRE(code.cost() == (occupied ? encode_cost(map.fused_cost(key)) : kNoCostData));
    ++known;
  });
  layer.for_each_changed({}, {}, [&](BlockOrdinal, const LayerBlock& block) {
    block.codes.for_each_known([&](std::uint32_t, VoxelCode) { --known; });
    return true;
  });
  REQUIRE(known == 0);
}

}  // namespace

TEST_CASE("after each tick the layer is what the self-map's voxels encode to") {
  SelfMap map(SelfMapConfig{});
  Replica layer(LayerId{1, 1, 1}, kDefaultResolution);
  std::uint32_t cursor = 0;
  std::uint32_t ticks = 0;
  for (const auto& scan : test::walk_through_room(test::Room{}, test::Lidar{}, 8)) {
    map.integrate(scan.view());
    add_costs(map, scan);
    layer.publish(blocks_changed_since(map, cursor));
    cursor = map.cursor();
    CHECK(layer.holdings().at(0) == Revision{++ticks});
    check_published(map, layer);
  }
  CHECK(blocks_changed_since(map, cursor).empty());
  CHECK(layer.publish(blocks_changed_since(map, 0)) == Revision{ticks});
}
