// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/store/store_batch.hpp"

namespace warren {

// What is no block, as rows of a store. Decoders trust nothing.
using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

// A layer, and whether this node may go on writing it.
struct LayerRow {
  LayerHead head;
  bool closed = false;  // revisions of it may have left the node that the store no longer knows
  std::uint64_t written_at = 0;  // number of the commit that wrote it last
};
Bytes encode_layer_row(const LayerRow& row);
std::optional<LayerRow> decode_layer_row(ByteView bytes);

Bytes encode_self_head(const SelfLayerHead& head);
std::optional<SelfLayerHead> decode_self_head(ByteView bytes);

// All of the item but its bytes.
Bytes encode_item_head(const LogItem& item);
std::optional<LogItem> decode_item_head(ByteView bytes);

// A counter or a state by its name.
struct NamedRow {
  std::string name;
  bool is_counter = false;
  Bytes content;
};
Bytes encode_named(const NamedRow& row);
std::optional<NamedRow> decode_named(ByteView bytes);

// The one row of the store itself. Its first four bytes are the schema's version in every release.
struct StoreRow {
  std::uint32_t schema = 0;
  std::uint64_t store = 0;    // random, drawn when the file was made
  std::uint64_t commits = 0;  // how many this store has seen
};
Bytes encode_store_row(const StoreRow& row);
std::optional<StoreRow> decode_store_row(ByteView bytes);

}  // namespace warren
