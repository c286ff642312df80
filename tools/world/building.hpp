// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "tools/world/floor_plan.hpp"
#include "tools/world/network.hpp"
#include "tools/world/random.hpp"

namespace warren::world {

// An office block on two levels that share one plan. Two corridors run along x, A in the south and
// B in the north; every 8 m of them is a bay with rooms south of A, north of B, and two rows
// between. All lengths are whole cells of 0.25 m.
class Building {
 public:
  static constexpr double kCell_m = 0.25;
  static constexpr double kBay_m = 8.0;
  static constexpr double kWall_m = 0.25;
  static constexpr double kStorey_m = 3.6;
  static constexpr double kRoom_m = 3.0;        // height
  static constexpr double kStairwell_m = 2.75;  // width, beyond either end of the corridors
  static constexpr std::array<double, 2> kCorridorY = {0.0, 12.75};
  static constexpr double kHalfCorridor_m = 1.0;

  Building(int bays, const Random& random);

  void build();

  TriangleMesh mesh() const;  // all of it, after build()
  const PassageGraph& passages() const { return network_.graph; }
  const std::vector<Stairway>& stairways() const { return stairways_; }

 private:
  // A row of rooms and the corridor that its doors open to.
  struct Row {
    double low_y;
    double high_y;
    int corridor;
    bool is_north_of_it;
  };
  static const std::array<Row, 4> kRows;

  bool is_hall(int bay) const { return bay % 3 == 1; }
  bool has_hump(int level, int bay) const { return !is_hall(bay) && bay % 4 == 2 - 2 * level; }
  double x_of(int bay) const { return bay * kBay_m; }
  double floor_of(int level) const { return level * kStorey_m; }
  double end_x() const { return x_of(bays_) - kWall_m; }

  void build_corridor(int level, int corridor);
  void build_hump(int level, int bay);
  void build_bay(int level, int bay);
  void build_room(int level, int bay, const Row& row);
  void build_sunken_room();
  void build_hall(int level, int bay);
  void furnish(const Eigen::AlignedBox3d& room, double door_x);
  void build_stairwell(bool is_east);
  void hang_cables(int level, int corridor, int bay);
  // Door of 1 m and a way through it, from a corridor's node to a place in the room.
  std::uint32_t open_door(int level, const Row& row, int bay, int node_in_bay, double depth_m);
  std::uint32_t corridor_node(int level, int corridor, int bay, int node_in_bay) const;
  std::uint32_t walk(std::uint32_t from, const Eigen::Vector3d& to, double half_width_m);

  int bays_;
  Random random_;
  FloorPlan plan_;
  Network network_;
  std::array<std::array<std::vector<std::uint32_t>, 2>, 2> corridor_nodes_;  // level, corridor
  std::vector<Stairway> stairways_;
  TriangleMesh objects_;
};

}  // namespace warren::world
