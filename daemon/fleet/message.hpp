// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/replication/item.hpp"

namespace warren {

// A message of an application to another node's applications, or to everybody's, as an item of its
// sender's log. The item's bytes:
//   kind, version  1 byte  0x32
//   time           8       microseconds since 1970, by the sender's clock
//   bytes          to the end
// Its name, if it has a key (message_key.hpp): 'm', the addressee's number (4 bytes; ff.. for all),
// the key.
struct Message {
  static constexpr std::uint8_t kKind = 0x32;
  static constexpr std::size_t kBytesMax = 200'000;

  std::optional<MemberId> to;  // none: everybody
  bool urgent = false;         // goes before what is not
  std::string key;             // of one key and addressee only the latest counts; empty: all count
  std::int64_t time_us = 0;
  std::vector<std::uint8_t> bytes;
  friend bool operator==(const Message&, const Message&) = default;
};

// Precondition: within the bounds above.
replication::Item item_of(const Message& message);
// Nothing if the item is none that item_of() makes.
std::optional<Message> read_message(const replication::Item& item);

}  // namespace warren
