// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include "tools/world/surface_nets.hpp"
#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

// Air along a straight piece of floor line; with both ends in one place, a chamber.
struct Passage {
  struct End {
    Eigen::Vector3d floor;
    double half_width_m = 1.5;
    double height_m = 2.5;
  };
  End from;
  End to;
  // Ends square, and its floor is not blended with the others': for the air over a flight of
  // stairs.
  bool is_flight = false;
};

// Upright air that no floor cuts off.
struct Shaft {
  Eigen::Vector3d bottom;
  double top_z_m = 0.0;
  double radius_m = 1.0;
};

enum class Section : std::uint8_t {
  kOval,   // as water leaves it; at the floor three quarters as wide
  kDrift,  // as men cut it: a rectangle with rounded upper corners
};

// Rock with passages in it as a signed distance field, about metres near the surface. Where
// passages meet they merge smoothly, and the floor runs through all of their floor lines.
class RockField : public SurfaceField {
 public:
  struct Settings {
    Section section = Section::kOval;
    double wall_noise_m = 0.3;
    double wall_wavelength_m = 2.5;
    double floor_noise_m = 0.08;  // on the floor line; twice that at the walls
    double merge_m = 0.5;         // over which passages melt into one another
    std::uint64_t seed = 1;
  };
  RockField(const Settings& settings, std::vector<Passage> passages,
            std::vector<Shaft> shafts = {});

  double value(const Eigen::Vector3d& position) const override;
  bool may_cross(const Eigen::Vector3d& centre, double radius_m) const override;
  // Boxes that hold all air, with room for the noise.
  std::vector<Eigen::AlignedBox3d> boxes() const;
  // Height of the ground below a point in the air.
  double ground_z(const Eigen::Vector3d& position) const;

 private:
  struct Smooth {        // without noise
    double walls = 0.0;  // distance to the passages' walls and roof
    double floor_z = 0.0;
    double from_middle = 0.0;  // 0 on a floor line, 1 at the walls
    double others = 0.0;       // distance to shafts and flights
  };
  Smooth smooth_at(const Eigen::Vector3d& position) const;
  double value_of(const Smooth& smooth, const Eigen::Vector3d& position) const;
  void index_passage(std::uint32_t passage);
  Eigen::AlignedBox3d box_of(const Passage& passage) const;

  Settings settings_;
  std::vector<Passage> passages_;
  std::vector<Shaft> shafts_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> near_;  // by grid cell
};

// The field as triangles: kFloor where one can stand, kRock elsewhere.
TriangleMesh mesh_of(const RockField& field, double cell_m);

}  // namespace warren::world
