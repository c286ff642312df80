// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

struct Ray {
  Eigen::Vector3f origin;
  Eigen::Vector3f direction;  // unit
  float max_range_m = 1000.0F;
};

struct RayReturn {
  float range_m = 0.0F;
  std::uint32_t triangle = 0;  // index in the mesh
  Eigen::Vector3f normal;      // unit, as the triangle is wound
};

// Casts rays at a mesh (Embree, robust, one thread, SSE2 on every CPU: the same bytes everywhere).
// The mesh must outlive it. Casting is const and may be done by several threads.
class Caster {
 public:
  explicit Caster(const TriangleMesh& mesh);
  ~Caster();
  Caster(Caster&&) noexcept;
  Caster& operator=(Caster&&) noexcept;

  const TriangleMesh& mesh() const { return *mesh_; }
  // The first surface along the ray; both sides of a triangle count.
  std::optional<RayReturn> cast(const Ray& ray) const;
  // The range of cast() alone; infinity if nothing is there.
  float range_m(const Ray& ray) const;
  bool is_occluded(const Ray& ray) const;
  // Is there a surface between two points?
  bool is_occluded(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const;
  // Straight down from a point: the ground below, if there is any within `reach_m`.
  std::optional<RayReturn> down(const Eigen::Vector3f& from, float reach_m) const;

 private:
  struct Scene;
  const TriangleMesh* mesh_;
  std::unique_ptr<Scene> scene_;
};

}  // namespace warren::world
