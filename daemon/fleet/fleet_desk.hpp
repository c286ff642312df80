// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "daemon/control/fleet_request.hpp"
#include "daemon/fleet/fleet_map.hpp"
#include "daemon/fleet/fleet_path.hpp"
#include "daemon/fleet/message_desk.hpp"
#include "daemon/fleet/node_book.hpp"
#include "daemon/fleet/operator_orders.hpp"
#include "daemon/fleet/own_path.hpp"
#include "daemon/replication/replication.hpp"

namespace warren {

// Whatever goes through the logs beside poses and status: messages of applications, orders of the
// operator, paths. Of the fleet thread.
class FleetDesk {
 public:
  static constexpr std::size_t kPathPartsMax = 1024;  // of the own path, in the own log
  // Two bases of one name, a mistake, would else answer each other without a rest.
  static constexpr Duration kBetweenGivingAgain = std::chrono::seconds(5);
  static constexpr const char* kStopping = "warrend is stopping";

  struct Parts {
    MemberId self;
    NodeRole role = NodeRole::kRobot;
    std::uint64_t inbox = 0;  // fresh random number
    replication::Replication& replication;
    FleetMap& map;
    const NodeBook& nodes;
    std::function<void()> turn_soon;  // there is something to be stored
  };

  explicit FleetDesk(Parts parts);

  // What the driver tells: all logs are there; an item of others has come; at a tick, with the time
  // since 1970; a batch is stored, or not; things may have changed; it is over.
  void start();
  void on_item(const replication::ArrivedItem& arrived);
  void on_ticked(MeshTime now, std::int64_t time_us, bool last);
  void on_committed(MeshTime now, bool stored);
  void settle(MeshTime now);
  void stop();

  // Answers when it is stored, or with the reason why it will not be, in words for the client.
  using Answer = std::function<void(tl::expected<std::uint32_t, std::string>)>;
  void send(MeshTime now, const MessageSendOrder& order, std::int64_t time_us, Answer answer);
  InboxExcerpt read(MeshTime now, const MessageWatchQuestion& question);
  // The layers that it is about, as far as they are known here.
  using Layers = std::vector<LayerId>;
  void order(MeshTime now, const FleetOrder& order,
             std::function<void(tl::expected<Layers, std::string>)> answer);
  tl::expected<FleetPath, std::string> path(const TrajectoryQuestion& question);

  // By name, or why not.
  tl::expected<MemberId, std::string> find_node(const std::string& name) const;
  // Of this node's layers that are held here the one it writes now, or else its last; or why not.
  tl::expected<const Replica*, std::string> newest_layer(MemberId node) const;

  const MessageDesk& messages() const { return messages_; }
  const OperatorOrders& orders() const { return orders_; }

 private:
  // Items of the own log that are stored together.
  struct Waiting {
    mesh::NumberRange numbers;
    std::function<void(bool stored)> done;
  };
  void when_stored(const mesh::NumberRange& numbers, std::function<void(bool)> done);
  void give_up(MeshTime now, const mesh::NumberRange& numbers);
  void note_path(MeshTime now, std::int64_t time_us, bool last);
  void withdraw_old_path(MeshTime now);
  tl::expected<std::vector<Order>, std::string> drafts_of(const FleetOrder& order) const;
  tl::expected<const Replica*, std::string> layer_to_align(const FleetOrder& order,
                                                           MemberId node) const;
  tl::expected<Order, std::string> alignment_of(const FleetOrder& order, MemberId node) const;
  Layers layers_of(const Order& order) const;
  void give_again(MeshTime now);
  std::set<std::uint32_t> bases() const;

  Parts parts_;
  MessageDesk messages_;
  OperatorOrders orders_;
  OwnPath path_;
  std::vector<Waiting> waiting_;
  std::size_t layers_settled_ = 0;
  bool earlier_orders_came_ = false;  // of another life of this base
  MeshTime gave_again_ = MeshTime::min();
  bool stopped_ = false;
};

}  // namespace warren
