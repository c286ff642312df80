// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/mask_bytes.hpp"

namespace warren {
namespace {

enum Fill : std::uint32_t { kClear, kSet, kMixed };

Fill fill_of(std::uint64_t bits, std::uint64_t all) {
  return bits == 0 ? kClear : bits == all ? kSet : kMixed;
}

void write_word(std::uint64_t word, ByteWriter& writer) {
  std::uint32_t fills = 0;
  for (int byte = 0; byte < 8; ++byte) fills |= fill_of(word >> 8 * byte & 0xFF, 0xFF) << 2 * byte;
  writer.add(static_cast<std::uint16_t>(fills));
  for (int byte = 0; byte < 8; ++byte) {
    if ((fills >> 2 * byte & 3) == kMixed) writer.add(static_cast<std::uint8_t>(word >> 8 * byte));
  }
}

std::optional<std::uint64_t> read_word(ByteReader& reader) {
  const auto fills = reader.number<std::uint16_t>();
  std::uint64_t word = 0;
  for (int byte = 0; byte < 8; ++byte) {
    const std::uint32_t fill = fills >> 2 * byte & 3U;
    if (fill > kMixed) return std::nullopt;
    std::uint64_t bits = fill == kSet ? 0xFF : 0;
    if (fill == kMixed) bits = reader.number<std::uint8_t>();
    if (fill == kMixed && fill_of(bits, 0xFF) != kMixed) return std::nullopt;
    word |= bits << 8 * byte;
  }
  if (fill_of(word, kFullCell) != kMixed) return std::nullopt;
  return word;
}

}  // namespace

void write_mask(const VoxelMask& mask, ByteWriter& writer) {
  std::uint32_t fills = 0;
  for (std::size_t cell = 0; cell < mask.size(); ++cell) {
    fills |= fill_of(mask[cell], kFullCell) << 2 * cell;
  }
  writer.add(static_cast<std::uint16_t>(fills));
  for (std::size_t cell = 0; cell < mask.size(); ++cell) {
    if ((fills >> 2 * cell & 3) == kMixed) write_word(mask[cell], writer);
  }
}

std::optional<VoxelMask> read_mask(ByteReader& reader) {
  const auto fills = reader.number<std::uint16_t>();
  VoxelMask mask{};
  for (std::size_t cell = 0; cell < mask.size(); ++cell) {
    const std::uint32_t fill = fills >> 2 * cell & 3U;
    if (fill > kMixed) return std::nullopt;
    if (fill == kSet) mask[cell] = kFullCell;
    if (fill != kMixed) continue;
    const auto word = read_word(reader);
    if (!word) return std::nullopt;
    mask[cell] = *word;
  }
  if (!reader.complete()) return std::nullopt;
  return mask;
}

}  // namespace warren
