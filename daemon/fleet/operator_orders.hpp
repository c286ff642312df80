// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "daemon/fleet/order.hpp"

namespace warren {

// The orders of all bases, as far as they have come here. Which of them counts depends on nothing
// but the orders and on who is a base: not on the order of arrival, and on no clock. Orders of a
// node whose role is not known yet wait; those of a robot count for nothing.
class OperatorOrders {
 public:
  static constexpr std::size_t kOrdersMax = 4096;

  // From the log of `origin`. False, and counted: it is no order, somebody else's, or one too many.
  bool note(std::uint32_t origin, const replication::Item& item);
  // Which nodes are bases now; true if that, or an order since the last call, may change what
  // holds.
  bool settle(std::set<std::uint32_t> bases);

  // By the latest word on the layer, be it on that layer or on all of its node's.
  bool is_retracted(const LayerId& layer) const;
  // Nothing if there is none.
  std::optional<WrittenPose> correction_of(const LayerId& layer) const;
  // What this writer said last about what the item, an order, is about.
  const Order* held(std::uint32_t writer, const replication::Item& item) const;
  // For the next order on this node: above all that count; 0: there is none any more.
  std::uint32_t next_revision(std::uint32_t node) const;

  std::size_t size() const { return size_; }
  std::uint64_t refused() const { return refused_; }
  // Orders of nodes that are no base now.
  std::uint64_t unauthorised() const;

 private:
  using Subject = std::tuple<std::uint32_t, bool, std::optional<LayerId>>;
  static Subject subject_of(const Order& order);
  const Order* latest(const Subject& subject) const;

  std::map<Subject, std::map<std::uint32_t, Order>> orders_;  // by writer
  std::set<std::uint32_t> bases_;
  std::size_t size_ = 0;
  bool changed_ = false;
  std::uint64_t refused_ = 0;
};

}  // namespace warren
