// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/block_bytes.hpp"

#include <algorithm>
#include <bit>

#include "daemon/store/mask_bytes.hpp"
#include "daemon/store/value_bytes.hpp"

namespace warren {
namespace {

std::size_t count(const VoxelMask& mask) {
  int bits = 0;
  for (const std::uint64_t cell : mask) bits += std::popcount(cell);
  return static_cast<std::size_t>(bits);
}

bool is_within(const VoxelMask& part, const VoxelMask& whole) {
  for (std::size_t cell = 0; cell < part.size(); ++cell) {
    if ((part[cell] & ~whole[cell]) != 0) return false;
  }
  return true;
}

// One code per occupied voxel, in Morton order.
std::vector<std::uint8_t> costs_of(const BlockCodes& codes) {
  std::vector<std::uint8_t> costs;
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    for_each_bit(codes.occupied[cell],
                 [&](std::uint32_t bit) { costs.push_back(codes.costs[cell << 6 | bit]); });
  }
  return costs;
}

bool set_costs(std::span<const std::uint8_t> costs, BlockCodes& codes) {
  const std::uint8_t* next = costs.data();
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    for_each_bit(codes.occupied[cell],
                 [&](std::uint32_t bit) { codes.costs[cell << 6 | bit] = *next++; });
  }
  return std::all_of(costs.begin(), costs.end(), [](std::uint8_t cost) { return cost < 16; });
}

}  // namespace

std::vector<std::uint8_t> encode_block(const StoredBlock& block) {
  const BlockCodes codes = block.codes.unpack();
  ByteWriter writer;
  writer.add(block.changed_at.number);
  write_mask(codes.known, writer);
  write_mask(codes.occupied, writer);
  write_mask(codes.stairs, writer);
  write_values<std::uint8_t>(costs_of(codes), writer);
  return writer.take();
}

std::optional<StoredBlock> decode_block(BlockOrdinal block, std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  StoredBlock stored{block, {reader.number<std::uint32_t>()}, {}};
  const auto known = read_mask(reader);
  const auto occupied = read_mask(reader);
  const auto stairs = read_mask(reader);
  if (!known || !occupied || !stairs) return std::nullopt;
  if (!is_within(*occupied, *known) || !is_within(*stairs, *occupied)) return std::nullopt;
  BlockCodes codes{*known, *occupied, *stairs, {}};
  const auto costs = read_values<std::uint8_t>(count(*occupied), reader);
  if (!costs || !set_costs(*costs, codes)) return std::nullopt;
  if (!reader.complete() || reader.left() != 0 || stored.changed_at.number == 0) {
    return std::nullopt;
  }
  stored.codes = CodeBlock(codes);
  return stored;
}

std::vector<std::uint8_t> encode_self_block(const BlockState& state) {
  ByteWriter writer;
  writer.add(state.changed_at);
  write_mask(state.known, writer);
  write_mask(state.clamped_free, writer);
  write_mask(state.occupied, writer);
  write_mask(state.costed, writer);
  std::vector<std::uint16_t> values;
  for (const std::int16_t value : state.values) values.push_back(static_cast<std::uint16_t>(value));
  write_values<std::uint16_t>(values, writer);
  for (const FusedCost& cost : state.costs) writer.add(cost.cost);
  std::vector<std::uint16_t> information;
  for (const FusedCost& cost : state.costs) information.push_back(cost.information);
  write_values<std::uint16_t>(information, writer);
  return writer.take();
}

std::optional<BlockState> decode_self_block(BlockOrdinal block,
                                            std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  BlockState state;
  state.key = block_key_of(block);
  state.changed_at = reader.number<std::uint32_t>();
  for (VoxelMask* const mask :
       {&state.known, &state.clamped_free, &state.occupied, &state.costed}) {
    const auto read = read_mask(reader);
    if (!read) return std::nullopt;
    *mask = *read;
  }
  std::size_t stored = 0;
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    stored += static_cast<std::size_t>(std::popcount(state.stored(cell)));
  }
  const auto values = read_values<std::uint16_t>(stored, reader);
  if (!values) return std::nullopt;
  for (const std::uint16_t value : *values) {
    state.values.push_back(static_cast<std::int16_t>(value));
  }
  state.costs.resize(count(state.costed));
  for (FusedCost& cost : state.costs) cost.cost = reader.number<std::uint16_t>();
  const auto information = read_values<std::uint16_t>(state.costs.size(), reader);
  if (!information) return std::nullopt;
  for (std::size_t i = 0; i < state.costs.size(); ++i)
    state.costs[i].information = (*information)[i];
  if (!reader.complete() || reader.left() != 0 || !state.is_sound()) return std::nullopt;
  return state;
}

}  // namespace warren
