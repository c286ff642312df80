// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/layer/range_coder.hpp"

namespace warren {

// What a diff says of a voxel, or of a cube or cell of them as a whole. In the diff of a block that
// is replaced, "unchanged" stands for unknown.
enum class DiffState : std::uint8_t { kUnchanged, kFree, kOccupied, kMixed };
inline constexpr std::size_t kDiffStates = 4;

// The contexts of the adaptive bits of a packet, as consecutive runs. A new layout is a new format
// version.
namespace diff_context {

// States are decided by up to three bits: unchanged? mixed? occupied? The last of eight parts is
// not like the seven before if these are alike, which leaves it one bit less.
inline constexpr std::size_t kStateBits = 3;
inline constexpr std::size_t kPastNeighbourhoods = 64;    // states of 3 faces
inline constexpr std::size_t kFaceNeighbourhoods = 4096;  // states of 6 faces
inline constexpr std::size_t kFaceSets = 2;  // the second: four to six of eight, so far all alike
inline constexpr std::size_t kLastNeighbourhoods = 192;  // seven alike, states of 3 faces
inline constexpr std::size_t kNumberBits = 64;           // tree of a number's length
inline constexpr std::size_t kCostTree = 16;
inline constexpr std::size_t kCostMeans = 31;  // in half codes; 0: no neighbour's cost is known
inline constexpr std::size_t kCostSpreads = 7;

inline constexpr std::size_t kCell = 0;
inline constexpr std::size_t kCube = kCell + kPastNeighbourhoods * kStateBits;
inline constexpr std::size_t kLastCube = kCube + kFaceSets * kFaceNeighbourhoods * kStateBits;
inline constexpr std::size_t kVoxel = kLastCube + kLastNeighbourhoods * (kStateBits - 1);
inline constexpr std::size_t kLastVoxel =
    kVoxel + kFaceSets * kFaceNeighbourhoods * (kStateBits - 1);
inline constexpr std::size_t kStair = kLastVoxel + kLastNeighbourhoods;
inline constexpr std::size_t kNoData = kStair + 4;
inline constexpr std::size_t kCost = kNoData + 9;
inline constexpr std::size_t kMoreBlocks = kCost + kCostMeans * kCostSpreads * kCostTree;
inline constexpr std::size_t kRaw = kMoreBlocks + 1;
inline constexpr std::size_t kReplaces = kRaw + 1;  // by that of the block before
inline constexpr std::size_t kSameAge = kReplaces + 2;
inline constexpr std::size_t kAge = kSameAge + 1;
inline constexpr std::size_t kKeyStep = kAge + kNumberBits;
inline constexpr std::size_t kCount = kKeyStep + kNumberBits;

}  // namespace diff_context

// The table of priors holds one byte per context: the middle of a 256th of all probabilities.
constexpr Probability prior_of(std::uint8_t table_byte) {
  return static_cast<Probability>(table_byte << 8 | 0x80);
}

// What every packet's probabilities start from: kCount of them, trained by warren-train-priors.
// Belongs to the format version.
using DiffPriors = std::vector<Probability>;
const DiffPriors& diff_priors();

}  // namespace warren
