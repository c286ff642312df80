// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/exchange/atomic_file.hpp"
#include "core/layer/replica.hpp"

namespace warren {

// A layer in a file of its own: docs/PROTOCOL.md, "Layer files".
inline constexpr std::uint8_t kLayerFileVersion = 1;
inline constexpr std::uint64_t kLayerFileBytesMax = std::uint64_t{256} << 20;
// Some 30 km of tunnel at 0.1 m; about 400 MB of memory.
inline constexpr std::size_t kLayerFileBlocksMax = std::size_t{1} << 20;
inline constexpr std::size_t kLayerFilePacketBytesMax = std::size_t{16} << 10;

enum class LayerFileError : std::uint8_t {
  kNotALayer,
  kUnknownVersion,
  kCorrupt,  // the checksum says that the bytes are not those that were written
  kMalformed,
  kBadPose,  // not finite, no rotation, or beyond LayerPose::kReach_m
  kUnknownPacketVersion,
  kTooLarge,
  kDigestMismatch,
};
// A sentence without its dot.
const char* text_of(LayerFileError error);

// All that is held of the layer, be it partial: id, resolution, poses, holdings, blocks.
std::vector<std::uint8_t> encode_layer(const Replica& replica);
// Trusts nothing; bounded in time and memory on any input.
tl::expected<Replica, LayerFileError> decode_layer(std::span<const std::uint8_t> bytes);

// What encode_layer() made.
WriteResult write_encoded_layer(std::span<const std::uint8_t> bytes,
                                const std::filesystem::path& file);
WriteResult write_layer(const Replica& replica, const std::filesystem::path& file);
// The error names the file.
tl::expected<Replica, std::string> read_layer(const std::filesystem::path& file);

}  // namespace warren
