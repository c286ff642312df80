// SPDX-License-Identifier: Apache-2.0
// What members say of layers and logs: whatever is read encodes to the same bytes.
#include <algorithm>
#include <cassert>

#include "daemon/replication/announcement.hpp"
#include "daemon/replication/log_message.hpp"
#include "daemon/replication/map_message.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace {

using namespace warren::replication;

std::vector<std::uint8_t> encoded(const MapMessage& message) {
  if (const auto* const diff = std::get_if<DiffMessage>(&message)) return encode(*diff);
  if (const auto* const question = std::get_if<DigestQuestion>(&message)) return encode(*question);
  if (const auto* const answer = std::get_if<DigestAnswer>(&message)) return encode(*answer);
  std::vector<std::uint8_t> bytes{WishMessage::kKind};
  for (const Wish& wish : std::get<WishMessage>(message).wishes) append(bytes, wish);
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  if (const auto message = read_map_message(bytes)) {
    assert(std::ranges::equal(encoded(*message), bytes));
  }
  if (const auto announcement = read_announcement(bytes)) {
    assert(std::ranges::equal(encode(*announcement), bytes));
  }
  if (const auto announcement = read_log_announcement(bytes)) {
    assert(std::ranges::equal(encode(*announcement), bytes));
  }
  if (const auto parcel = read_item_parcel(bytes)) {
    assert(std::ranges::equal(encode(*parcel), bytes));
    (void)read_receipt(parcel->item);
    (void)read_layer_pose(parcel->item);
  }
  if (const auto parcel = read_void_parcel(bytes)) {
    assert(std::ranges::equal(encode(*parcel), bytes));
  }
  (void)read_log_wishes(bytes);
  return 0;
}
