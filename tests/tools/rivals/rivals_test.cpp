// SPDX-License-Identifier: Apache-2.0
#include <map>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "core/voxel/morton.hpp"
#include "tests/core/layer/random_codes.hpp"
#include "tools/rivals/octree7.hpp"
#include "tools/rivals/tree_zstd.hpp"

using namespace warren;

namespace {

constexpr std::uint64_t kMiddle = morton_of(VoxelKey{0, 0, 0});

VoxelCode random_known_code(test::Random& random) {
  const VoxelCode code = test::random_code(random);
  return code.state() == VoxelState::kUnknown ? VoxelCode::free() : code;
}

// Cubes of one code, of any size up to two blocks, and single voxels in and among them.
std::vector<ChangedVoxel> random_diff(test::Random& random) {
  std::map<std::uint64_t, VoxelCode> codes;
  for (std::uint32_t cubes = test::below(random, 12); cubes > 0; --cubes) {
    const int level = static_cast<int>(test::below(random, 5));
    const std::uint64_t size = voxels_of_level(level);
    const std::uint64_t first = kMiddle + test::below(random, 1U << 15) / size * size;
    const VoxelCode code = random_known_code(random);
    for (std::uint64_t i = 0; i < size; ++i) codes[first + i] = code;
  }
  for (std::uint32_t voxels = test::below(random, 200); voxels > 0; --voxels) {
    codes[kMiddle + test::below(random, 1U << 15)] = random_known_code(random);
  }
  std::vector<ChangedVoxel> diff;
  for (const auto& entry : codes) diff.push_back({entry.first, entry.second});
  return diff;
}

std::vector<ChangedVoxel> cube(std::uint64_t first, int level, VoxelCode code) {
  std::vector<ChangedVoxel> voxels;
  add_leaf(voxels, first, level, code);
  return voxels;
}

}  // namespace

TEST_CASE("every rival's encoding of a diff-map gives back its voxels") {
  CHECK(rc::check("round trip", [](std::uint64_t seed) {
    test::Random random(seed);
    const auto diff = random_diff(random);
    RC_ASSERT(decode_octree7(encode_octree7(diff, Pruning::kNone)) == diff);
    RC_ASSERT(decode_octree7(encode_octree7(diff, Pruning::kEqualCodes)) == diff);
    const auto tree = encode_tree(diff);
    RC_ASSERT(decode_tree(tree) == diff);
    RC_ASSERT(decompress_zstd(compress_zstd(tree)) == tree);
  }));
}

TEST_CASE("an inner node of the seven-bit octree takes seven bytes") {
  const std::vector<ChangedVoxel> one = {{kMiddle, VoxelCode::free()}};
  CHECK(encode_octree7(one, Pruning::kNone).size() == 16 * 7);
  const auto eight = cube(kMiddle, 1, VoxelCode::occupied(3, true));
  CHECK(encode_octree7(eight, Pruning::kNone).size() == 16 * 7);
  CHECK(encode_octree7(eight, Pruning::kEqualCodes).size() == 15 * 7);
}

TEST_CASE("a cube of one code is a single leaf and a cube of two costs is not") {
  auto voxels = cube(kMiddle, 2, VoxelCode::occupied(3, false));
  CHECK(encode_octree7(voxels, Pruning::kEqualCodes).size() == 14 * 7);
  // Two bytes per inner node, and five bits for the one leaf.
  CHECK(encode_tree(voxels).size() == 14 * 2 + 1);
  voxels[9].code = VoxelCode::occupied(4, false);
  CHECK(encode_octree7(voxels, Pruning::kEqualCodes).size() == 16 * 7);
  CHECK(encode_tree(voxels).size() == 16 * 2 + (15 * 5 + 7) / 8);
}

TEST_CASE("no change takes no bytes") {
  CHECK(encode_octree7({}, Pruning::kNone).empty());
  CHECK(encode_tree({}).empty());
}

TEST_CASE("changed voxels are those whose published codes differ, in Morton order") {
  BlockCodes before;
  before.set(5, VoxelCode::free());
  before.set(6, VoxelCode::occupied(1, false));
  BlockCodes after = before;
  after.set(6, VoxelCode::occupied(2, false));
  after.set(300, VoxelCode::free());
  BlockCodes fresh;
  fresh.set(511, VoxelCode::free());
  Replica published(LayerId{1, 1, 1}, kDefaultResolution);
  published.publish(std::vector<CodedBlock>{{7, CodeBlock(before)}});
  const std::vector<CodedBlock> now = {{7, CodeBlock(after)}, {3, CodeBlock(fresh)}};
  const std::vector<ChangedVoxel> expected = {{3 << 9 | 511, VoxelCode::free()},
                                              {7 << 9 | 6, VoxelCode::occupied(2, false)},
                                              {7 << 9 | 300, VoxelCode::free()}};
  CHECK(changed_voxels(now, published) == expected);
}
