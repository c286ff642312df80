// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/voxel_labels.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <unordered_set>

#include "tools/world/truth/triangle_box.hpp"

namespace warren::world {

VoxelLabels::VoxelLabels(const TriangleMesh& mesh, double resolution_m)
    : resolution_m_(resolution_m) {
  assert(resolution_m > 0.0);
  for (const Triangle& triangle : mesh.triangles)
    add_surface({mesh.vertices[triangle[0]].cast<double>(),
                 mesh.vertices[triangle[1]].cast<double>(),
                 mesh.vertices[triangle[2]].cast<double>()});
}

void VoxelLabels::add_surface(const std::array<Eigen::Vector3d, 3>& triangle) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& corner : triangle) bounds.extend(corner);
  const Index low = index_of(bounds.min());
  const Index high = index_of(bounds.max());
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int z = low.z(); z <= high.z(); ++z)
        if (triangle_touches_box(triangle, centre_of({x, y, z}), resolution_m_ / 2.0))
          labels_[key_of({x, y, z})] = VoxelTruth::kSurface;
}

void VoxelLabels::add_free(const Sight& sight, std::span<const Eigen::Isometry3d> viewpoints) {
  std::vector<Index> open;
  std::unordered_set<Key> tried;
  const auto look = [&](const Index& index) {
    if (!tried.insert(key_of(index)).second) return;
    if (!sight.sees(centre_of(index).cast<float>())) return;
    labels_.try_emplace(key_of(index), VoxelTruth::kFree);
    open.push_back(index);
  };
  for (const Eigen::Isometry3d& T : viewpoints) look(index_of(T.translation()));
  while (!open.empty()) {
    const Index here = open.back();
    open.pop_back();
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) look(here + side * Index::Unit(axis));
  }
}

VoxelTruth VoxelLabels::at(const Index& index) const {
  const auto found = labels_.find(key_of(index));
  return found == labels_.end() ? VoxelTruth::kUnseen : found->second;
}

VoxelLabels::Index VoxelLabels::index_of(const Eigen::Vector3d& position) const {
  return (position / resolution_m_).array().floor().cast<int>();
}

Eigen::Vector3d VoxelLabels::centre_of(const Index& index) const {
  return (index.cast<double>().array() + 0.5) * resolution_m_;
}

std::size_t VoxelLabels::count(VoxelTruth label) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(labels_, [&](const auto& item) { return item.second == label; }));
}

VoxelLabels::Key VoxelLabels::key_of(const Index& index) {
  constexpr int kHalf = 1 << 20;
  assert((index.array().abs() < kHalf).all());
  const auto part = [&](int axis) { return static_cast<Key>(index[axis] + kHalf) << (21 * axis); };
  return part(0) | part(1) | part(2);
}

}  // namespace warren::world
