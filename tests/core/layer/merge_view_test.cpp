// SPDX-License-Identifier: Apache-2.0
#include "core/layer/merge_view.hpp"

#include <array>
#include <limits>
#include <map>
#include <utility>

#include <doctest/doctest.h>

#include "core/layer/publisher.hpp"
#include "core/terrain/ground.hpp"
#include "tests/core/layer/merge_peer.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;
using test::MergePeer;

namespace {

constexpr LayerId kOther{7, 1, 0x1234};
constexpr double kResolution_m = 0.1;

// A floor around the origin, one voxel thick, with a cost for each of its voxels.
std::vector<CodedBlock> floor_of(
    const std::map<std::pair<std::int32_t, std::int32_t>, VoxelCode>& exceptions, VoxelCode code) {
  std::vector<CodedBlock> blocks;
  for (std::int32_t x = -1; x <= 0; ++x) {
    for (std::int32_t y = -1; y <= 0; ++y) {
      BlockCodes codes;
      for (std::int32_t i = 0; i < kBlockEdge * kBlockEdge; ++i) {
        const std::int32_t key_x = x * kBlockEdge + i % kBlockEdge;
        const std::int32_t key_y = y * kBlockEdge + i / kBlockEdge;
        const auto exception = exceptions.find({key_x, key_y});
        codes.set(morton9(key_x, key_y, 0),
                  exception == exceptions.end() ? code : exception->second);
      }
      blocks.push_back({ordinal_of({x, y, 0}), CodeBlock(codes)});
    }
  }
  return blocks;
}

GroundQuery query_on_floor() {
  GroundQuery query;
  query.T_layer_base.translation().z() = 0.3;
  return query;
}

VoxelCode code_of(float cost) {
  const FusedCost fused{static_cast<std::uint16_t>(cost * 65535.0F), 256};
  return VoxelCode::occupied(encode_cost(fused), false);
}

// The merge-map of one who got this floor from another by packets.
MergePeer peer_with(const std::vector<CodedBlock>& blocks) {
  Replica origin(kOther, kDefaultResolution);
  origin.publish(blocks);
  MergePeer peer(kOther, kResolution_m);
  peer.catch_up(origin);
  return peer;
}

}  // namespace

TEST_CASE("an unknown cost has its own code, and is never taken for an easy one on the merge-map") {
  const VoxelCode no_data = VoxelCode::occupied(kNoCostData, false);
  MergePeer nothing_judged = peer_with(floor_of({}, no_data));
  const MergeView view(nothing_judged.map());
  CHECK(view.state({0, 0, 0}) == VoxelState::kOccupied);
  CHECK_FALSE(view.cost({0, 0, 0}));
  const GroundReport report = ground(view, query_on_floor());
  CHECK(report.columns_with_ground == report.columns);
  CHECK_FALSE(report.mean_cost);
  CHECK(validity(report, false) == Validity::kUnknown);

  MergePeer one_not_judged = peer_with(floor_of({{{1, 1}, no_data}}, code_of(0.02F)));
  CHECK(validity(MergeView(one_not_judged.map()), query_on_floor(), false) == Validity::kUnknown);
  MergePeer all_judged = peer_with(floor_of({}, code_of(0.02F)));
  CHECK(validity(MergeView(all_judged.map()), query_on_floor(), false) == Validity::kTraversable);
}

TEST_CASE("what nobody knows is no ground on the merge-map") {
  MergeMap map({kResolution_m});
  const GroundReport report = ground(MergeView(map), query_on_floor());
  CHECK(report.columns_with_ground == 0);
  CHECK(validity(report, true) == Validity::kUnknown);
}

TEST_CASE("a cost on the merge-map is never below the one measured") {
  for (int thousandths = 0; thousandths <= 1000; ++thousandths) {
    const float cost = static_cast<float>(thousandths) / 1000.0F;
    const auto decoded = decode_cost(code_of(cost).cost());
    REQUIRE(decoded);
    REQUIRE(*decoded >= cost - 2e-5F);  // the step of the fixed point
  }
  MergePeer barely_too_hard = peer_with(floor_of({{{1, 1}, code_of(0.201F)}}, code_of(0.02F)));
  const GroundReport report = ground(MergeView(barely_too_hard.map()), query_on_floor());
  CHECK(*report.max_cost == doctest::Approx(0.25));
  CHECK(validity(report, false) == Validity::kTooHard);
}

TEST_CASE("who got every diff has all costs on the same side of the planner's limits") {
  constexpr std::int32_t kVoxels = 64;
  test::SimulatedScan scan;
  scan.origin_layer = {0.05F, 0.05F, 1.05F};
  std::vector<VoxelCost> costs;
  for (std::int32_t x = 0; x < kVoxels; ++x) {
    scan.points_layer.push_back({0.1F * static_cast<float>(x) + 0.05F, 0.05F, 0.05F});
  }
  SelfMap map(SelfMapConfig{});
  Replica origin(kOther, kDefaultResolution);
  MergePeer peer(kOther, kResolution_m);
  std::uint32_t cursor = 0;
  for (int tick = 0; tick < 20; ++tick) {
    map.integrate(scan.view());
    costs.clear();
    for (std::int32_t x = 0; x < kVoxels; ++x) {
      const float cost = 0.01F * static_cast<float>((x * 7 + tick * 3) % 40);
      costs.push_back({{x, 0, 0}, cost, 1.0F});
    }
    map.fuse_costs(costs);
    origin.publish(blocks_changed_since(map, cursor));
    cursor = map.cursor();
    peer.catch_up(origin);
    const MergeView view(peer.map());
    for (std::int32_t x = 0; x < kVoxels; ++x) {
      const VoxelKey key{x, 0, 0};
      const auto measured = map.cost(key);
      const auto merged = view.cost(key);
      REQUIRE(measured);
      REQUIRE(merged);
      CHECK(*merged >= *measured);
      for (const float limit : {0.1F, 0.2F}) CHECK((*merged > limit) == (*measured > limit));
    }
  }
}

TEST_CASE("stairs on voxels known from others alone are stairs, and come and go by themselves") {
  const VoxelCode step = VoxelCode::occupied(15, true);
  Replica origin(kOther, kDefaultResolution);
  MergePeer peer(kOther, kResolution_m);
  const MergeView view(peer.map());
  for (const VoxelCode code : {VoxelCode::occupied(15, false), step, code_of(0.5F)}) {
    origin.publish(floor_of({}, code));
    peer.catch_up(origin);
    CHECK(view.is_stair({0, 0, 0}) == code.stair());
    const GroundReport report = ground(view, query_on_floor());
    CHECK(report.stairs_share == (code.stair() ? 1.0 : 0.0));
    CHECK(validity(report, true) == (code.stair() ? Validity::kStairs : Validity::kTooHard));
    CHECK(validity(report, false) == Validity::kTooHard);
  }
  CHECK_FALSE(view.is_stair({0, 0, 300}));
}

TEST_CASE("a ray through the merge-map stops where somebody saw a wall") {
  BlockCodes wall;
  BlockCodes air;
  for (std::int32_t x = 0; x < kBlockEdge; ++x) air.set(morton9(x, 0, 0), VoxelCode::free());
  wall.set(morton9(0, 0, 0), VoxelCode::free());
  wall.set(morton9(1, 0, 0), code_of(1.0F));
  const std::vector<CodedBlock> blocks = {{ordinal_of({0, 0, 0}), CodeBlock(air)},
                                          {ordinal_of({1, 0, 0}), CodeBlock(wall)}};
  MergePeer peer = peer_with(blocks);
  const RayQuery query{{0.05F, 0.05F, 0.05F}, {1.0F, 0.0F, 0.0F}, 5.0, true};
  const auto hit = peer.map().cast_ray(query);
  REQUIRE(hit);
  CHECK(hit->key == VoxelKey{9, 0, 0});
  CHECK(hit->state == VoxelState::kOccupied);
  CHECK(hit->range_m == doctest::Approx(0.85).epsilon(1e-6));

  REQUIRE(peer.map().retract_layer(kOther) == MergeResult::kDone);
  const auto unknown = peer.map().cast_ray(query);
  REQUIRE(unknown);
  CHECK(unknown->key == VoxelKey{0, 0, 0});
  CHECK(unknown->state == VoxelState::kUnknown);
}
