// SPDX-License-Identifier: Apache-2.0
// What FleetDesk does with the operator's orders.
#include <algorithm>
#include <string>
#include <utility>

#include "daemon/control/layer_shift.hpp"
#include "daemon/fleet/fleet_desk.hpp"
#include "daemon/fleet/orders_again.hpp"
#include "daemon/log.hpp"

namespace warren {
namespace {

constexpr const char* kNotOrdered = "it could not be stored, and is not ordered";
constexpr const char* kNoBase =
    "this node is a robot: only a base gives orders to the fleet; map retract, restore and move "
    "are for this node alone";

}  // namespace

std::set<std::uint32_t> FleetDesk::bases() const {
  std::set<std::uint32_t> bases;
  for (const auto& [member, node] : parts_.nodes.nodes()) {
    if (node.status.role == NodeRole::kBase) bases.insert(member.number);
  }
  bases.erase(parts_.self.number);
  if (parts_.role == NodeRole::kBase) bases.insert(parts_.self.number);
  return bases;
}

// They count at once: what the store refuses now it is asked to take again.
void FleetDesk::give_again(MeshTime now) {
  replication::LogBook& book = parts_.replication.log_book();
  const bool due = earlier_orders_came_ && parts_.role == NodeRole::kBase &&
                   book.own() != nullptr && now - kBetweenGivingAgain >= gave_again_;
  if (!due) return;
  earlier_orders_came_ = false;
  std::vector<Order> of_this_life;
  std::vector<Order> of_earlier_lives;
  for (const auto& held : book.logs()) {
    if (held->log.id().origin != parts_.self.number) continue;
    for (const auto& [number, item] : held->log.items()) {
      const auto order = read_order(item);
      if (order) (held->own ? of_this_life : of_earlier_lives).push_back(*order);
    }
  }
  std::vector<Order> orders = orders_to_give_again(of_this_life, of_earlier_lives);
  if (orders.empty()) return;
  std::vector<replication::Item> items;
  for (Order& order : orders) {
    order.revision = orders_.next_revision(order.node);
    if (order.revision == 0) continue;
    items.push_back(item_of(order));
    (void)orders_.note(parts_.self.number, items.back());
  }
  gave_again_ = now;
  const bool said = !items.empty() && book.append_all(now, items).has_value();
  log_warning("fleet: orders of an earlier life of this base have come that would undo " +
              std::to_string(orders.size()) + " of its orders: " +
              (said ? "these are given again" : "these cannot be given again, its log is full"));
  parts_.turn_soon();
}

void FleetDesk::settle(MeshTime now) {
  const std::size_t layers = parts_.map.own_layers().size() + parts_.map.loaded().size();
  const bool grown = std::exchange(layers_settled_, layers) != layers;
  const bool changed = orders_.settle(bases());
  give_again(now);
  if (!changed && !grown) return;
  std::vector<LayerId> others;
  parts_.map.loaded().for_each([&](const Replica& layer) { others.push_back(layer.id()); });
  for (const LayerId& id : others) {
    parts_.map.loaded().set_retracted_by_fleet(id, orders_.is_retracted(id));
  }
  bool moved = false;
  for (const auto& held : parts_.replication.book().layers()) {
    const auto correction = orders_.correction_of(held->id);
    if (!correction) continue;
    if (held->copy) {
      moved = held->copy->pose().update_correction(*correction) == PoseResult::kTaken || moved;
    } else {
      (void)parts_.map.correct_own(held->id, *correction);
    }
  }
  if (moved) parts_.map.place_others();
}

FleetDesk::Layers FleetDesk::layers_of(const Order& order) const {
  if (order.layer) return {*order.layer};
  Layers layers;
  for (const auto& held : parts_.replication.book().layers()) {
    if (held->id.origin == order.node) layers.push_back(held->id);
  }
  return layers;
}

tl::expected<const Replica*, std::string> FleetDesk::layer_to_align(const FleetOrder& wanted,
                                                                    MemberId node) const {
  if (!wanted.layer) return newest_layer(node);
  const replication::HeldLayer* const held = parts_.replication.book().find(*wanted.layer);
  if (held != nullptr) return &held->replica();
  return tl::unexpected(std::string("only a layer that the mesh brought here can be aligned"));
}

// The correction that brings the layer from where its origin says to where it shall lie.
tl::expected<Order, std::string> FleetDesk::alignment_of(const FleetOrder& wanted,
                                                         MemberId node) const {
  const auto layer = layer_to_align(wanted, node);
  if (!layer) return tl::unexpected(layer.error());
  const LayerPose& pose = (*layer)->pose();
  const auto T_fleet_layer = pose.origin().pose.checked();
  if (pose.origin().revision == 0 || !T_fleet_layer) {
    return tl::unexpected(std::string("where the layer lies is not known here yet"));
  }
  const Eigen::Isometry3d correction =
      shifted(*T_fleet_layer, wanted.shift) * T_fleet_layer->inverse();
  Order order;
  order.verb = Order::Verb::kAlign;
  order.revision = std::max(orders_.next_revision(node.number), pose.correction().revision + 1);
  order.writer = parts_.self.number;
  order.node = node.number;
  order.layer = (*layer)->id();
  order.correction = Pose::of(correction);
  LayerPose corrected = pose;
  if (corrected.update_correction({order.revision, order.writer, order.correction}) !=
      PoseResult::kTaken) {
    return tl::unexpected(std::string("there the layer would lie out of reach"));
  }
  return order;
}

tl::expected<std::vector<Order>, std::string> FleetDesk::drafts_of(const FleetOrder& wanted) const {
  Order order;
  order.writer = parts_.self.number;
  order.layer = wanted.layer;
  if (wanted.layer) {
    const bool known = parts_.replication.book().find(*wanted.layer) != nullptr ||
                       parts_.map.loaded().find(*wanted.layer).has_value();
    if (!known) return tl::unexpected(std::string("no such layer is known here"));
    order.node = wanted.layer->origin;
  } else {
    const auto node = find_node(wanted.node);
    if (!node) return tl::unexpected(node.error());
    order.node = node->number;
  }
  order.revision = orders_.next_revision(order.node);
  if (wanted.what == FleetOrder::What::kAlign) {
    auto aligned = alignment_of(wanted, MemberId{order.node});
    if (!aligned) return tl::unexpected(aligned.error());
    return std::vector<Order>{*aligned};
  }
  const bool restores = wanted.what == FleetOrder::What::kRestore;
  order.verb = restores ? Order::Verb::kRestore : Order::Verb::kRetract;
  if (wanted.what != FleetOrder::What::kClear) return std::vector<Order>{order};
  // All that it has written so far, but nothing that it begins later.
  std::vector<Order> orders;
  for (const LayerId& layer : layers_of(order)) {
    order.layer = layer;
    orders.push_back(order);
  }
  if (orders.empty()) return tl::unexpected("no layer of " + wanted.node + " is held here");
  return orders;
}

void FleetDesk::order(MeshTime now, const FleetOrder& wanted,
                      std::function<void(tl::expected<Layers, std::string>)> answer) {
  if (stopped_) return answer(tl::unexpected(std::string(kStopping)));
  if (parts_.role != NodeRole::kBase) return answer(tl::unexpected(std::string(kNoBase)));
  const auto drafts = drafts_of(wanted);
  if (!drafts) return answer(tl::unexpected(drafts.error()));
  Layers layers;
  std::vector<replication::Item> items;
  for (const Order& draft : *drafts) {
    if (draft.revision == 0) {
      return answer(tl::unexpected(std::string("no further order on this node can be given")));
    }
    const Layers of = layers_of(draft);
    layers.insert(layers.end(), of.begin(), of.end());
    items.push_back(item_of(draft));
  }
  const auto numbers = parts_.replication.log_book().append_all(now, items);
  if (!numbers) return answer(tl::unexpected(std::string("this node's log is full")));
  when_stored(*numbers, [this, items, layers, answer = std::move(answer)](bool stored) {
    if (!stored) return answer(tl::unexpected(std::string(kNotOrdered)));
    for (const replication::Item& item : items) (void)orders_.note(parts_.self.number, item);
    parts_.turn_soon();
    answer(layers);
  });
}

}  // namespace warren
