// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/log_exchange.hpp"

#include <algorithm>

#include <doctest/doctest.h>

namespace warren::replication {
namespace {

const MeshTime kNow{std::chrono::seconds(5)};
constexpr LogId kLog{7, 0x55};

struct Receiver {
  Receiver() { config.self = {3}; }
  std::size_t finished() const {
    return static_cast<std::size_t>(std::count_if(
        commands.begin(), commands.end(),
        [](const Command& command) { return std::holds_alternative<FinishParcel>(command); }));
  }
  void take(std::uint32_t parcel, ItemNumber number) {
    Item item;
    item.bytes = {1, 2, 3};
    REQUIRE(exchange.on_parcel(kNow, {MemberId{9},
                                      {1, parcel},
                                      mesh::ParcelClass::kMessage,
                                      encode(ItemParcel{kLog, number, item})}));
  }
  void batch(std::uint64_t number) {
    (void)exchange.book().take_batch(number);
    exchange.on_batch(number);
  }

  ReplicationConfig config;
  std::deque<Command> commands;
  LogExchange exchange{config, commands};
};

TEST_CASE("a parcel is finished when what it brought is stored, one that brings nothing at once") {
  Receiver receiver;
  receiver.take(1, 0);
  CHECK(receiver.finished() == 0);
  receiver.batch(1);
  // The same item again, from the same or another, while it is being stored.
  receiver.take(2, 0);
  CHECK(receiver.finished() == 0);
  receiver.exchange.on_stored(kNow, 1);
  CHECK(receiver.finished() == 2);
  // And when nothing is left to be stored there is no batch that could tell.
  receiver.take(3, 0);
  CHECK(receiver.finished() == 3);
  receiver.take(4, 1);
  CHECK(receiver.finished() == 3);
  receiver.batch(2);
  receiver.exchange.on_stored(kNow, 2);
  CHECK(receiver.finished() == 4);
}

TEST_CASE("a parcel whose batch was refused is finished when the next one is stored") {
  Receiver receiver;
  receiver.take(1, 0);
  receiver.batch(1);
  receiver.exchange.on_refused(1);
  CHECK(receiver.finished() == 0);
  receiver.take(2, 0);
  receiver.batch(2);
  receiver.exchange.on_stored(kNow, 2);
  CHECK(receiver.finished() == 2);
}

}  // namespace
}  // namespace warren::replication
