// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/layer/claim.hpp"

namespace warren {

// How far a subscriber's copy of some blocks has come. A *sweep* tells, block by block in key
// order, what changed after `since`, each block as it is when its turn comes; once it is through,
// the copy has all that changed up to where the sweep began. So a copy may fall behind as far as it
// likes: what it gets next is the newest state. The client holds this as bytes that mean nothing to
// it.
struct BlocksCursor {
  std::uint64_t run = 0;    // drawn when the daemon starts: numbers of another run mean nothing
  std::uint64_t scope = 0;  // of which source, in which box
  std::uint64_t frame = 0;  // where keys count from
  std::uint64_t since = 0;
  std::uint64_t until = 0;          // number of the last change when the sweep began
  BlockOrdinal next = kOrdinalEnd;  // where the sweep goes on; the end: it is through

  bool is_through() const { return next == kOrdinalEnd; }
  friend bool operator==(const BlocksCursor&, const BlocksCursor&) = default;
};

std::string encode_cursor(const BlocksCursor& cursor);
// Nothing if no daemon makes such bytes.
std::optional<BlocksCursor> decode_cursor(std::string_view bytes);

}  // namespace warren
