// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "daemon/fleet/message.hpp"
#include "daemon/replication/log_book.hpp"

namespace warren {

// A message that has come, by its number in the inbox.
struct InboxMessage {
  std::uint64_t number = 0;  // from 1, rising
  MemberId from;
  replication::LogId log;
  replication::ItemNumber item = 0;
  Message message;
};

// What a reader of the inbox gets: messages above its cursor, oldest first.
struct InboxExcerpt {
  std::uint64_t inbox = 0;  // numbers of another one mean nothing here
  std::vector<InboxMessage> messages;
  std::uint64_t next = 0;    // the cursor to go on with
  std::uint64_t missed = 0;  // above the cursor, and not kept any more
  bool more = false;
};

// Messages of applications, on their way out and in. Bounds of what waits in the own log: messages
// to one node wait for their receipt, and when too many do a new one is refused; of those to
// everybody the latest are kept. The inbox keeps the latest of what came; one that nobody fetched
// before it had to go comes again after a restart, if it was for this node alone.
class MessageDesk {
 public:
  static constexpr std::size_t kInboxMax = 1024;
  static constexpr std::size_t kInboxBytesMax = 4'000'000;
  static constexpr std::size_t kWaitingMax = 1024;
  static constexpr std::size_t kWaitingBytesMax = 2'000'000;
  static constexpr std::size_t kToAllMax = 256;
  static constexpr std::size_t kToAllBytesMax = 800'000;
  static constexpr std::size_t kExcerptBytesMax = 400'000;

  // `inbox` is a fresh random number. The book must outlive this.
  MessageDesk(MemberId self, std::uint64_t inbox, replication::LogBook& book)
      : self_(self), inbox_id_(inbox), book_(book) {}

  // Puts it into the own log; its number there, or why not, in words for the client.
  tl::expected<replication::ItemNumber, std::string> send(MeshTime now, const Message& message);
  // An item that has come. What is no message, or not for this node, is left alone.
  void take_in(const replication::LogId& log, replication::ItemNumber number,
               const replication::Item& item);
  // What is above the cursor `after` of that inbox; of another inbox all. What the cursor leaves
  // behind has been fetched.
  InboxExcerpt read(MeshTime now, std::uint64_t inbox, std::uint64_t after);

  // Items of kind message that could not be read, and messages that left the inbox unfetched.
  std::uint64_t unreadable() const { return unreadable_; }
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Waiting {
    std::size_t count = 0;
    std::size_t bytes = 0;
    void add(const replication::Item& item);
  };
  void withdraw_old(MeshTime now, const replication::Item& next);
  Waiting waiting_for_receipt() const;
  void note_fetched(MeshTime now, std::uint64_t up_to);
  void make_room();

  MemberId self_;
  std::uint64_t inbox_id_;
  replication::LogBook& book_;
  std::deque<InboxMessage> inbox_;
  std::size_t inbox_bytes_ = 0;
  std::uint64_t last_ = 0;     // number given last
  std::uint64_t fetched_ = 0;  // all up to it
  std::uint64_t unreadable_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace warren
