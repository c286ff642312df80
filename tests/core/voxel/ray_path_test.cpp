// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/ray_path.hpp"

#include <cmath>
#include <vector>

#include <doctest/doctest.h>
#include <octomap/OcTree.h>
#include <rapidcheck.h>

using warren::key_of_morton;
using warren::Lattice;
using warren::Point3f;
using warren::RayPath;
using warren::RayWalker;
using warren::VoxelKey;

namespace {

struct Ray {
  Point3f origin;
  Point3f end;
};

std::vector<VoxelKey> voxels_of(RayPath& path, const RayWalker& walker) {
  std::vector<VoxelKey> voxels;
  if (walker.remaining == 0) return voxels;
  std::uint64_t code = walker.code();
  for (const std::uint64_t step : path.unroll(walker)) {
    voxels.push_back(key_of_morton(code));
    code ^= step;
  }
  CHECK((code & RayPath::kEndOfRay) != 0);
  return voxels;
}

std::vector<VoxelKey> ours(double resolution, const Ray& ray) {
  const Lattice lattice(resolution);
  RayPath path(lattice);
  const auto from = lattice.key_of(ray.origin);
  const auto to = lattice.key_of(ray.end);
  if (!from || !to) return {};
  return voxels_of(path, path.trace(ray.origin, *from, ray.end, *to));
}

std::vector<VoxelKey> octomaps(double resolution, const Ray& ray) {
  const octomap::OcTree tree(resolution);
  octomap::KeyRay keys;
  tree.computeRayKeys({ray.origin.x, ray.origin.y, ray.origin.z}, {ray.end.x, ray.end.y, ray.end.z},
                      keys);
  std::vector<VoxelKey> voxels;
  for (const octomap::OcTreeKey& key : keys) {
    voxels.push_back(
        {key[0] + warren::kKeyMin, key[1] + warren::kKeyMin, key[2] + warren::kKeyMin});
  }
  return voxels;
}

// Half of the coordinates lie on voxel borders, centres or diagonals: where ties are decided.
rc::Gen<float> coordinate(double resolution) {
  return rc::gen::oneOf(
      rc::gen::map(rc::gen::inRange(-200, 200),
                   [=](int i) { return static_cast<float>(i * resolution); }),
      rc::gen::map(rc::gen::inRange(-200, 200),
                   [=](int i) { return static_cast<float>((i + 0.5) * resolution); }),
      rc::gen::map(rc::gen::inRange(-2000000, 2000000),
                   [](int i) { return static_cast<float>(i) * 1e-5F; }),
      rc::gen::just(0.0F), rc::gen::just(1e-12F), rc::gen::just(-1e-7F));
}

rc::Gen<Point3f> point(double resolution) {
  return rc::gen::build<Point3f>(rc::gen::set(&Point3f::x, coordinate(resolution)),
                                 rc::gen::set(&Point3f::y, coordinate(resolution)),
                                 rc::gen::set(&Point3f::z, coordinate(resolution)));
}

}  // namespace

TEST_CASE("a ray passes the voxels that OctoMap's does, in its order") {
  CHECK(rc::check("same voxels as computeRayKeys", [] {
    const double resolution = *rc::gen::element(0.05, 0.1, 0.15, 0.2, 0.3, 1.0);
    const Ray ray{*point(resolution), *point(resolution)};
    RC_ASSERT(ours(resolution, ray) == octomaps(resolution, ray));
  }));
}

TEST_CASE("exact diagonals pass the voxels that OctoMap's do") {
  for (const float reach : {0.35F, 1.0F, 7.0F, 19.9F}) {
    for (int corner = 0; corner < 27; ++corner) {
      const auto sign = [&](int divisor) {
        return static_cast<float>(corner / divisor % 3 - 1) * reach;
      };
      const Ray ray{{0.0F, 0.0F, 0.0F}, {sign(1), sign(3), sign(9)}};
      CAPTURE(corner);
      CAPTURE(reach);
      CHECK(ours(0.1, ray) == octomaps(0.1, ray));
    }
  }
}

TEST_CASE("a ray within one voxel passes none") {
  CHECK(ours(0.1, {{0.01F, 0.01F, 0.01F}, {0.09F, 0.05F, 0.02F}}).empty());
}

TEST_CASE("leaving a block lands on the voxel that stepping gets to") {
  CHECK(rc::check("leave_block skips the same voxels", [] {
    const double resolution = 0.1;
    const Ray ray{*point(resolution), *point(resolution)};
    const Lattice lattice(resolution);
    RayPath path(lattice);
    const auto from = lattice.key_of(ray.origin);
    const auto to = lattice.key_of(ray.end);
    RC_PRE(from && to && *from != *to);
    RayWalker walker = path.trace(ray.origin, *from, ray.end, *to);
    const std::vector<VoxelKey> all = voxels_of(path, walker);
    std::size_t at = 0;
    while (true) {
      std::size_t next = at;
      while (next < all.size() && block_of(all[next]) == block_of(all[at])) ++next;
      const bool more = walker.leave_block();
      RC_ASSERT(more == (next < all.size()));
      if (!more) break;
      RC_ASSERT(key_of_morton(walker.code()) == all[next]);
      RC_ASSERT(walker.remaining == static_cast<std::int64_t>(all.size() - next));
      const std::vector<VoxelKey> rest = voxels_of(path, walker);
      RC_ASSERT(rest ==
                std::vector<VoxelKey>(all.begin() + static_cast<std::ptrdiff_t>(next), all.end()));
      at = next;
    }
  }));
}

TEST_CASE("a ray across the whole key space is walked exactly") {
  const Ray ray{{-3276.0F, -3270.0F, 3276.5F}, {3276.0F, 3000.0F, -3276.0F}};
  const std::vector<VoxelKey> voxels = ours(0.1, ray);
  CHECK(voxels.size() > 65000);
  CHECK(voxels.front() == *Lattice(0.1).key_of(ray.origin));
}
