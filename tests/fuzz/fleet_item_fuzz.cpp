// SPDX-License-Identifier: Apache-2.0
// Messages, orders and paths: what is read of an item makes the same item.
#include <cassert>

#include "daemon/fleet/message.hpp"
#include "daemon/fleet/order.hpp"
#include "daemon/fleet/path_chunk.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  const auto item = replication::read_item({data, size});
  if (!item) return 0;
  if (const auto message = read_message(*item)) {
    assert(message->bytes.size() <= Message::kBytesMax);
    assert(item_of(*message) == *item);
  }
  if (const auto order = read_order(*item)) {
    assert(item_of(*order).bytes == item->bytes && item_of(*order).name == item->name);
  }
  if (const auto chunk = read_path_chunk(*item)) {
    assert(!chunk->points.empty() && chunk->points.size() <= PathChunk::kPointsMax);
    assert(item_of(*chunk).bytes == item->bytes && item_of(*chunk).name == item->name);
  }
  return 0;
}
