// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/operator_orders.hpp"

#include <algorithm>
#include <utility>

namespace warren {
namespace {

std::pair<std::uint32_t, std::uint32_t> rank_of(const Order& order) {
  return {order.revision, order.writer};
}

const Order* later_of(const Order* a, const Order* b) {
  if (a == nullptr || b == nullptr) return a == nullptr ? b : a;
  return rank_of(*a) < rank_of(*b) ? b : a;
}

}  // namespace

OperatorOrders::Subject OperatorOrders::subject_of(const Order& order) {
  return {order.node, order.verb == Order::Verb::kAlign, order.layer};
}

bool OperatorOrders::note(std::uint32_t origin, const replication::Item& item) {
  const auto order = read_order(item);
  if (!order || order->writer != origin || order->revision == 0) {
    ++refused_;
    return false;
  }
  auto& of_subject = orders_[subject_of(*order)];
  const auto held = of_subject.find(origin);
  if (held != of_subject.end()) {
    if (held->second.revision >= order->revision) return true;
    held->second = *order;
  } else {
    if (size_ >= kOrdersMax) {
      ++refused_;
      return false;
    }
    of_subject.emplace(origin, *order);
    ++size_;
  }
  changed_ = true;
  return true;
}

bool OperatorOrders::settle(std::set<std::uint32_t> bases) {
  const bool others = bases != bases_;
  bases_ = std::move(bases);
  return std::exchange(changed_, false) || others;
}

const Order* OperatorOrders::latest(const Subject& subject) const {
  const Order* best = nullptr;
  const auto found = orders_.find(subject);
  if (found == orders_.end()) return best;
  for (const auto& [writer, order] : found->second) {
    if (bases_.contains(writer)) best = later_of(best, &order);
  }
  return best;
}

bool OperatorOrders::is_retracted(const LayerId& layer) const {
  const Order* const word = later_of(latest(Subject{layer.origin, false, std::nullopt}),
                                     latest(Subject{layer.origin, false, layer}));
  return word != nullptr && word->verb == Order::Verb::kRetract;
}

std::optional<WrittenPose> OperatorOrders::correction_of(const LayerId& layer) const {
  const Order* const word = latest(Subject{layer.origin, true, layer});
  if (word == nullptr) return std::nullopt;
  return WrittenPose{word->revision, word->writer, word->correction};
}

const Order* OperatorOrders::held(std::uint32_t writer, const replication::Item& item) const {
  const auto order = read_order(item);
  const auto of_subject = order ? orders_.find(subject_of(*order)) : orders_.end();
  if (of_subject == orders_.end()) return nullptr;
  const auto found = of_subject->second.find(writer);
  return found == of_subject->second.end() ? nullptr : &found->second;
}

std::uint32_t OperatorOrders::next_revision(std::uint32_t node) const {
  std::uint32_t highest = 0;
  for (const auto& [subject, of_subject] : orders_) {
    if (std::get<0>(subject) != node) continue;
    for (const auto& [writer, order] : of_subject) {
      if (bases_.contains(writer)) highest = std::max(highest, order.revision);
    }
  }
  return highest + 1;
}

std::uint64_t OperatorOrders::unauthorised() const {
  std::uint64_t orders = 0;
  for (const auto& [subject, of_subject] : orders_) {
    for (const auto& [writer, order] : of_subject) orders += bases_.contains(writer) ? 0 : 1;
  }
  return orders;
}

}  // namespace warren
