// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/rays_answer.hpp"

#include "core/voxel/ray_cast.hpp"

namespace warren {
namespace {

Point3f point_of(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

bool has_key(const Lattice& lattice, const Eigen::Vector3d& place) {
  return lattice.key_of(place.x(), place.y(), place.z()).has_value();
}

RayEnd cast(const Lattice& lattice, const RayQuery& query, const CodeOf& code_of) {
  const auto hit =
      cast_ray(lattice, query, [&](const VoxelKey& key) { return code_of(key).state(); });
  if (!hit) return {query.max_range_m, std::nullopt, VoxelCode::free()};
  return {hit->range_m, hit->key, code_of(hit->key)};
}

}  // namespace

tl::expected<RaysAnswer, std::string> cast_rays(const RayPlace& place, const RaysQuestion& question,
                                                const CodeOf& code_of) {
  const double resolution_m = place.lattice.resolution_m();
  const double voxels_each = question.max_range_m / resolution_m;
  if (static_cast<double>(question.rays.size()) * voxels_each > RaysAnswer::kVoxelsMax) {
    return tl::unexpected(std::string(
        "the rays are over 131072 voxels long together: ask for fewer, or for less range"));
  }
  RaysAnswer answer{resolution_m, place.origin_map, {}};
  for (const MapRay& ray : question.rays) {
    const Eigen::Vector3d from = ray.origin_map - place.origin_map;
    const Eigen::Vector3d to = from + ray.direction_map * question.max_range_m;
    if (!has_key(place.lattice, from) || !has_key(place.lattice, to)) {
      return tl::unexpected(std::string("a ray leaves the map's keys"));
    }
    answer.ends.push_back(cast(place.lattice,
                               {point_of(from), point_of(ray.direction_map), question.max_range_m,
                                !question.through_unknown},
                               code_of));
  }
  return answer;
}

VoxelCode LayerVoxels::operator()(const VoxelKey& key) {
  const BlockOrdinal block = ordinal_of(block_of(key));
  if (block != block_) {
    block_ = block;
    codes_ = &layer_->codes_in_place(block);
  }
  return codes_->at(morton9(key.x, key.y, key.z));
}

}  // namespace warren
