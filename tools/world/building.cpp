// SPDX-License-Identifier: Apache-2.0
#include "tools/world/building.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/world/shapes.hpp"

namespace warren::world {
namespace {

constexpr int kNodesInBay = 4;  // at 1, 3, 5 and 7 m
constexpr double kDoorHeight_m = 2.1;

Eigen::AlignedBox3d box_of(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return {low, high};
}

double node_x(int bay, int node_in_bay) { return bay * Building::kBay_m + 1.0 + 2.0 * node_in_bay; }

}  // namespace

const std::array<Building::Row, 4> Building::kRows = {{
    {-7.25, -1.25, 0, false},
    {1.25, 6.25, 0, true},
    {6.5, 11.5, 1, false},
    {14.0, 20.0, 1, true},
}};

Building::Building(int bays, const Random& random)
    : bays_(bays),
      random_(random),
      plan_({Eigen::Vector2d(-3.25, -7.5), Eigen::Vector2d(bays * kBay_m + 3.0, 20.25)}, kCell_m) {}

void Building::build() {
  for (int level = 0; level < 2; ++level) {
    for (int corridor = 0; corridor < 2; ++corridor) build_corridor(level, corridor);
    for (int bay = 0; bay < bays_; ++bay) build_bay(level, bay);
  }
  build_stairwell(false);
  build_stairwell(true);
}

TriangleMesh Building::mesh() const {
  TriangleMesh all = plan_.mesh();
  all.append(objects_);
  for (const Stairway& stairs : stairways_) all.append(solid_of(stairs));
  return all;
}

std::uint32_t Building::corridor_node(int level, int corridor, int bay, int node_in_bay) const {
  return corridor_nodes_[static_cast<std::size_t>(level)][static_cast<std::size_t>(corridor)]
                        [static_cast<std::size_t>(bay * kNodesInBay + node_in_bay)];
}

std::uint32_t Building::walk(std::uint32_t from, const Eigen::Vector3d& to, double half_width_m) {
  return network_.add_way(from, {to, half_width_m}, kRoom_m, Air::kNone);
}

void Building::build_corridor(int level, int corridor) {
  const double y = kCorridorY[static_cast<std::size_t>(corridor)];
  const double z = floor_of(level);
  plan_.carve(box_of({0.0, y - kHalfCorridor_m, z}, {end_x(), y + kHalfCorridor_m, z + kRoom_m}));
  auto& nodes =
      corridor_nodes_[static_cast<std::size_t>(level)][static_cast<std::size_t>(corridor)];
  for (int i = 0; i < bays_ * kNodesInBay; ++i) {
    nodes.push_back(network_.add_node({{node_x(0, i), y, z}, kHalfCorridor_m}, kRoom_m));
    if (i > 0) network_.graph.add_edge(nodes[nodes.size() - 2], nodes.back());
  }
}

void Building::build_bay(int level, int bay) {
  if (is_hall(bay)) build_hall(level, bay);
  if (has_hump(level, bay)) build_hump(level, bay);
  for (const Row& row : kRows) {
    const bool is_taken = (is_hall(bay) && (&row == &kRows[1] || &row == &kRows[2])) ||
                          (has_hump(level, bay) && row.corridor == 1);
    if (is_taken) continue;
    if (level == 0 && bay == 0 && &row == &kRows[0])
      build_sunken_room();
    else
      build_room(level, bay, row);
  }
  for (int corridor = 0; corridor < 2; ++corridor)
    if (random_.chance(0.6)) hang_cables(level, corridor, bay);
}

// A ramp up and a ramp down across corridor B, over the middle of the bay.
void Building::build_hump(int level, int bay) {
  constexpr double kRamp_m = 2.0;  // from node to node
  const double y = kCorridorY[1];
  const double z = floor_of(level);
  const double angle_rad = random_.uniform(5.0, 15.0) * std::numbers::pi / 180.0;
  const Ramp ramp{.angle_rad = angle_rad,
                  .height_m = kRamp_m * std::tan(angle_rad),
                  .width_m = 2.0 * kHalfCorridor_m};
  objects_.append(wedge(ramp), upright({node_x(bay, 0), y, z}, 0.0));
  objects_.append(wedge(ramp), upright({node_x(bay, 3), y, z}, std::numbers::pi));
  objects_.append(box(box_of({node_x(bay, 1), y - kHalfCorridor_m, z},
                             {node_x(bay, 2), y + kHalfCorridor_m, z + ramp.height_m}),
                      Surface::kFloor));
  for (const int node : {1, 2})
    network_.graph.nodes[corridor_node(level, 1, bay, node)].position.z() += ramp.height_m;
}

std::uint32_t Building::open_door(int level, const Row& row, int bay, int node_in_bay,
                                  double depth_m) {
  const double x = node_x(bay, node_in_bay);
  const double z = floor_of(level);
  const double side = row.is_north_of_it ? 1.0 : -1.0;
  const double corridor_y = kCorridorY[static_cast<std::size_t>(row.corridor)];
  const double face_y = corridor_y + side * kHalfCorridor_m;
  const double inner_y = face_y + side * kWall_m;
  plan_.carve(box_of({x - 0.5, std::min(face_y, inner_y), z},
                     {x + 0.5, std::max(face_y, inner_y), z + kDoorHeight_m}));
  return walk(corridor_node(level, row.corridor, bay, node_in_bay),
              {x, inner_y + side * depth_m, z}, 0.5);
}

void Building::build_room(int level, int bay, const Row& row) {
  const double z = floor_of(level);
  const double width_m = kBay_m - kWall_m - kCell_m * random_.below(5);
  const double depth_m = row.high_y - row.low_y - 2 * kCell_m * random_.below(5);
  const double low_y = row.is_north_of_it ? row.low_y : row.high_y - depth_m;
  const auto room =
      box_of({x_of(bay), low_y, z}, {x_of(bay) + width_m, low_y + depth_m, z + kRoom_m});
  plan_.carve(room);
  const int node = static_cast<int>(1 + random_.below(2));
  open_door(level, row, bay, node, depth_m / 2.0);
  furnish(room, node_x(bay, node));
}

// Cupboards and tables, away from the way in.
void Building::furnish(const Eigen::AlignedBox3d& room, double door_x) {
  const std::uint32_t pieces = random_.below(4);
  for (std::uint32_t i = 0; i < pieces; ++i) {
    const Eigen::Vector3d size(random_.uniform(0.4, 1.2), random_.uniform(0.4, 1.6),
                               random_.uniform(0.5, 1.8));
    const Eigen::Vector3d low(random_.uniform(room.min().x(), room.max().x() - size.x()),
                              random_.uniform(room.min().y(), room.max().y() - size.y()),
                              room.min().z());
    const bool is_in_the_way = low.x() < door_x + 0.8 && low.x() + size.x() > door_x - 0.8;
    if (!is_in_the_way) objects_.append(box(box_of(low, low + size), Surface::kWall));
  }
}

// Bay 0 south of A: a floor with a deep end, and stairs down into it.
void Building::build_sunken_room() {
  constexpr double kDeep_m = -1.44;
  const Row& row = kRows[0];
  plan_.carve(box_of({0.0, row.low_y, 0.0}, {kBay_m - kWall_m, row.high_y, kRoom_m}));
  plan_.carve(box_of({2.0, row.low_y, kDeep_m}, {kBay_m - kWall_m, -3.25, kRoom_m}));
  const Stairway stairs{.foot = {2.0 + 8 * 0.29, -5.25, kDeep_m},
                        .yaw_rad = std::numbers::pi,
                        .steps = 8,
                        .rise_m = -kDeep_m / 8,
                        .run_m = 0.29,
                        .width_m = 1.5};
  stairways_.push_back(stairs);
  std::uint32_t high = open_door(0, row, 0, 1, 1.0);
  high = walk(high, {1.0, -2.25, 0.0}, 0.8);
  high = walk(high, {1.0, -5.25, 0.0}, 0.8);
  const std::uint32_t low = network_.add_node({{6.0, -5.25, kDeep_m}, 1.0}, kRoom_m);
  network_.join(network_.climb(low, stairs, 0.7), high, Air::kNone);
}

// From A of one level to B of the other: in the west up towards the north, in the east to the
// south.
void Building::build_stairwell(bool is_east) {
  const double low_x = is_east ? x_of(bays_) : -3.0;
  const double high_x = low_x + kStairwell_m;
  const double x = (low_x + high_x) / 2.0;
  const int from = is_east ? 1 : 0;
  const double end_y = is_east ? 2.5 : 10.0;
  const double side = is_east ? -1.0 : 1.0;
  const double from_y = kCorridorY[static_cast<std::size_t>(from)];
  const double to_y = kCorridorY[static_cast<std::size_t>(1 - from)];
  const auto carve = [&](double x0, double x1, double y0, double y1, double z0, double z1) {
    plan_.carve(box_of({x0, std::min(y0, y1), z0}, {x1, std::max(y0, y1), z1}));
  };
  const double west = is_east ? end_x() : low_x;
  const double east = is_east ? high_x : 0.0;
  carve(west, east, from_y - 1.0, from_y + 1.0, 0.0, kRoom_m);
  carve(west, east, to_y - 1.0, to_y + 1.0, kStorey_m, kStorey_m + kRoom_m);
  carve(low_x, high_x, from_y + side, end_y, 0.0, kStorey_m + kRoom_m);
  carve(low_x, high_x, end_y, to_y - side, kStorey_m, kStorey_m + kRoom_m);

  const std::uint32_t steps = 18 + 2 * random_.below(4);
  const double run_m = random_.uniform(0.25, 0.3);
  const Stairway stairs{.foot = {x, end_y - side * steps * run_m, 0.0},
                        .yaw_rad = side * std::numbers::pi / 2.0,
                        .steps = steps,
                        .rise_m = kStorey_m / steps,
                        .run_m = run_m,
                        .width_m = 2.25};
  stairways_.push_back(stairs);
  const int bay = is_east ? bays_ - 1 : 0;
  const int node = is_east ? kNodesInBay - 1 : 0;
  const std::uint32_t low = walk(corridor_node(0, from, bay, node), {x, from_y, 0.0}, 1.0);
  const std::uint32_t top = network_.climb(low, stairs, 1.1);
  const std::uint32_t high = walk(top, {x, to_y, kStorey_m}, 1.0);
  network_.join(high, corridor_node(1, 1 - from, bay, node), Air::kNone);
}

}  // namespace warren::world
