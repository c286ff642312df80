// SPDX-License-Identifier: Apache-2.0
#include "tools/world/wall_following.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "tools/world/placement.hpp"

namespace warren::world {
namespace {

constexpr double kPi = std::numbers::pi;

struct Walker {
  Eigen::Vector3d position;
  double yaw_rad = 0.0;
  bool has_wall = false;  // at the right hand; goes straight on until it has
  double lost_rad = 0.0;  // turned to the right since the wall was felt last
};

// Every 15 degrees from a little to the right over ahead and left to back: the first that is free
// is taken.
constexpr int kHeadings = 15;
double turn_of(int index) { return (index - 2) * kPi / 12.0; }

Eigen::Vector3d along(double yaw_rad) { return {std::cos(yaw_rad), std::sin(yaw_rad), 0.0}; }

bool has_room(const Caster& caster, const Vehicle& vehicle, const Walker& walker, double yaw_rad,
              double room_m) {
  const Eigen::Vector3d middle =
      walker.position + Eigen::Vector3d(0.0, 0.0, vehicle.clearance_m + 0.2);
  const Eigen::Vector3d left = along(yaw_rad + kPi / 2.0) * vehicle.body_width_m / 2.0;
  for (const double side : {-1.0, 0.0, 1.0}) {
    const Eigen::Vector3d from = middle + side * left;
    if (caster.is_occluded(
            Ray{from.cast<float>(), along(yaw_rad).cast<float>(), static_cast<float>(room_m)}))
      return false;
  }
  return true;
}

std::optional<Walker> turn_and_step(const Caster& caster, const Vehicle& vehicle,
                                    const Walker& walker, double turn_rad, double step_m) {
  Walker next = walker;
  next.yaw_rad += turn_rad;
  const Eigen::Vector3d goal = walker.position + step_m * along(next.yaw_rad);
  const Placement placement =
      place(caster, vehicle, {goal.x(), goal.y(), walker.position.z(), next.yaw_rad});
  if (!placement.is_ok()) return std::nullopt;
  next.position = placement.T_world_base->translation();
  return next;
}

// Round and round without a wall: the thing at the right hand was a pillar, or nothing.
void note_turn(Walker& walker, int index) {
  walker.lost_rad = index == 0 ? walker.lost_rad - turn_of(0) : 0.0;
  if (walker.lost_rad > 2.5 * kPi) walker.has_wall = false;
}

std::optional<Walker> follow(const Caster& caster, const Vehicle& vehicle, const Walker& walker,
                             const WallFollowing& config) {
  for (const double room_m : {config.room_m, 0.5 * config.room_m, config.step_m})
    for (int index = 0; index < kHeadings; ++index) {
      const double turn_rad = turn_of(index);
      if (!has_room(caster, vehicle, walker, walker.yaw_rad + turn_rad, room_m)) continue;
      auto next = turn_and_step(caster, vehicle, walker, turn_rad, config.step_m);
      if (!next) continue;
      note_turn(*next, index);
      return next;
    }
  return std::nullopt;
}

std::optional<Walker> step_on(const Caster& caster, const Vehicle& vehicle, Walker walker,
                              const WallFollowing& config) {
  if (!walker.has_wall && has_room(caster, vehicle, walker, walker.yaw_rad, config.room_m))
    if (auto next = turn_and_step(caster, vehicle, walker, 0.0, config.step_m)) return next;
  if (!walker.has_wall) walker.lost_rad = 0.0;
  walker.has_wall = true;
  return follow(caster, vehicle, walker, config);
}

}  // namespace

Route follow_wall(const Caster& caster, const Vehicle& vehicle, const Eigen::Vector3d& start,
                  double start_yaw_rad, const WallFollowing& config) {
  Route route{start};
  std::optional<Walker> walker = Walker{.position = start, .yaw_rad = start_yaw_rad};
  for (std::uint32_t step = 0; step < config.steps; ++step) {
    walker = step_on(caster, vehicle, *walker, config);
    if (!walker) break;
    route.push_back(walker->position);
    const bool is_back = step * config.step_m > 20.0 * config.room_m &&
                         (walker->position - start).norm() < config.room_m;
    if (is_back) break;
  }
  return route;
}

}  // namespace warren::world
