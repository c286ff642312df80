// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/fleet_desk.hpp"

#include <algorithm>
#include <utility>

namespace warren {
namespace {

using replication::ItemKind;
using replication::ItemNumber;

constexpr const char* kNotSent = "it could not be stored, and is not sent";

}  // namespace

FleetDesk::FleetDesk(Parts parts)
    : parts_(std::move(parts)),
      messages_(parts_.self, parts_.inbox, parts_.replication.log_book()) {}

// Messages to this node alone come once more by themselves, if nobody fetched them.
void FleetDesk::start() {
  earlier_orders_came_ = true;
  for (const auto& held : parts_.replication.log_book().logs()) {
    for (const auto& [number, item] : held->log.items()) {
      if (item.kind == ItemKind::kCommand) (void)orders_.note(held->log.id().origin, item);
      if (!item.to) messages_.take_in(held->log.id(), number, item);
    }
  }
}

void FleetDesk::on_item(const replication::ArrivedItem& arrived) {
  if (arrived.item.kind == ItemKind::kCommand) {
    (void)orders_.note(arrived.log.origin, arrived.item);
    if (arrived.log.origin == parts_.self.number) earlier_orders_came_ = true;
  }
  messages_.take_in(arrived.log, arrived.number, arrived.item);
}

void FleetDesk::on_ticked(MeshTime now, std::int64_t time_us, bool last) {
  if (!stopped_) note_path(now, time_us, last);
}

void FleetDesk::note_path(MeshTime now, std::int64_t time_us, bool last) {
  const auto position = parts_.map.position_layer();
  replication::LogBook& book = parts_.replication.log_book();
  if (!position || book.own() == nullptr) return;
  const LayerId& layer = parts_.map.own_layers().rbegin()->second.layer().id();
  if (path_.layer() != layer) path_.begin(layer, next_path_number(book, layer));
  const auto part = path_.note(now, {time_us, *position}, last);
  if (!part) return;
  withdraw_old_path(now);
  if (parts_.replication.append(now, item_of(*part))) parts_.turn_soon();
}

void FleetDesk::withdraw_old_path(MeshTime now) {
  replication::LogBook& book = parts_.replication.log_book();
  std::vector<ItemNumber> path;
  for (const auto& [number, item] : book.own()->log.items()) {
    if (item.kind == ItemKind::kTrajectory) path.push_back(number);
  }
  if (path.size() < kPathPartsMax) return;
  mesh::ByteRanges oldest;
  oldest.add({path.front(), path.front() + 1ULL});
  book.withdraw(now, oldest);
}

void FleetDesk::when_stored(const mesh::NumberRange& numbers, std::function<void(bool)> done) {
  waiting_.push_back({numbers, std::move(done)});
  parts_.turn_soon();
}

// What is not stored will not be sent either.
void FleetDesk::on_committed(MeshTime now, bool stored) {
  const replication::HeldLog* const own = parts_.replication.log_book().own();
  std::vector<Waiting> still;
  std::vector<std::pair<std::function<void(bool)>, bool>> done;
  for (Waiting& waiting : std::exchange(waiting_, {})) {
    const bool is_stored = own != nullptr && own->stored.contains(waiting.numbers);
    if (is_stored || !stored) {
      if (!is_stored) give_up(now, waiting.numbers);
      done.emplace_back(std::move(waiting.done), is_stored);
    } else {
      still.push_back(std::move(waiting));
    }
  }
  waiting_ = std::move(still);
  for (const auto& [tell, is_stored] : done) tell(is_stored);
}

// An order that stood in the place of one of these is said again: it still holds.
void FleetDesk::give_up(MeshTime now, const mesh::NumberRange& numbers) {
  replication::LogBook& book = parts_.replication.log_book();
  std::vector<Order> before;
  for (std::uint64_t number = numbers.first; number < numbers.end; ++number) {
    const replication::Item* const item = book.own()->log.find(static_cast<ItemNumber>(number));
    const Order* const held = item == nullptr ? nullptr : orders_.held(parts_.self.number, *item);
    if (held != nullptr) before.push_back(*held);
  }
  mesh::ByteRanges withdrawn;
  withdrawn.add(numbers);
  book.withdraw(now, withdrawn);
  for (const Order& order : before) (void)book.append(now, item_of(order));
}

void FleetDesk::stop() {
  stopped_ = true;
  for (const Waiting& waiting : std::exchange(waiting_, {})) waiting.done(false);
}

void FleetDesk::send(MeshTime now, const MessageSendOrder& order, std::int64_t time_us,
                     Answer answer) {
  if (stopped_) return answer(tl::unexpected(std::string(kStopping)));
  Message message{std::nullopt, order.urgent, order.key, time_us, order.bytes};
  if (!order.to.empty()) {
    const auto to = find_node(order.to);
    if (!to) return answer(tl::unexpected(to.error()));
    message.to = *to;
  }
  const auto number = messages_.send(now, message);
  if (!number) return answer(tl::unexpected(number.error()));
  when_stored({*number, *number + 1ULL},
              [answer = std::move(answer), number = *number](bool stored) {
                stored ? answer(number) : answer(tl::unexpected(std::string(kNotSent)));
              });
}

InboxExcerpt FleetDesk::read(MeshTime now, const MessageWatchQuestion& question) {
  InboxExcerpt excerpt = messages_.read(now, question.inbox, question.after);
  parts_.turn_soon();  // there may be receipts
  return excerpt;
}

tl::expected<FleetPath, std::string> FleetDesk::path(const TrajectoryQuestion& question) {
  const auto node = find_node(question.node);
  if (!node) return tl::unexpected(node.error());
  return path_of(parts_.replication, orders_, *node, question.after_us);
}

tl::expected<MemberId, std::string> FleetDesk::find_node(const std::string& name) const {
  for (const auto& [member, node] : parts_.nodes.nodes()) {
    if (node.status.name == name) return member;
  }
  return tl::unexpected("no node called " + name + " is known here; fleet status lists them");
}

// By its own word, if there is one: a node that lost its store begins again to count its layers.
tl::expected<const Replica*, std::string> FleetDesk::newest_layer(MemberId node) const {
  const NodeBook::Node* const known = parts_.nodes.find(node);
  const std::string name =
      known != nullptr ? known->status.name : "node " + std::to_string(node.number);
  const replication::LayerBook& book = parts_.replication.book();
  if (known != nullptr && known->status.layer) {
    const replication::HeldLayer* const current = book.find(known->status.layer->id);
    if (current != nullptr) return &current->replica();
    return tl::unexpected("the layer that " + name + " writes now is not held here");
  }
  const Replica* newest = nullptr;
  for (const auto& held : book.layers()) {
    if (held->id.origin != node.number) continue;
    if (newest == nullptr || held->id.number >= newest->id().number) newest = &held->replica();
  }
  if (newest != nullptr) return newest;
  return tl::unexpected("no layer of " + name + " is held here");
}

}  // namespace warren
