// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace warren::world {

// What a triangle belongs to: tells cables from rock in benchmarks and colours in pictures.
enum class Surface : std::uint8_t {
  kRock,
  kFloor,
  kWall,
  kCeiling,
  kStairs,
  kRamp,
  kRail,
  kBoulder,
  kRubble,
  kStepfield,
  kCable,
  kFence,
  kImported,
};
inline constexpr std::size_t kSurfaceCount = 13;
const char* name_of(Surface surface);  // snake_case

using Triangle = std::array<std::uint32_t, 3>;  // indices, counter-clockwise seen from the air

// Metres, z up, gravity is -z. Every triangle has a surface.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Triangle> triangles;
  std::vector<Surface> surfaces;  // as many as triangles

  // Adds another mesh, moved by `T_world_mesh`.
  void append(const TriangleMesh& other,
              const Eigen::Isometry3d& T_world_mesh = Eigen::Isometry3d::Identity());
  void add_triangle(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                    Surface surface);
  // Two triangles; corners counter-clockwise seen from the air.
  void add_quad(const std::array<Eigen::Vector3f, 4>& corners, Surface surface);
  Eigen::AlignedBox3f bounds() const;
};

}  // namespace warren::world
