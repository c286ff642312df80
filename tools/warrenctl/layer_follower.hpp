// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <tl/expected.hpp>

#include "core/layer/replica.hpp"

namespace warren {

namespace control {
class Request;
class Response;
}  // namespace control

// Keeps a copy of a daemon's current layer by asking for what it lacks: what any program may do
// that wants the map and its changes.
class LayerFollower {
 public:
  using Ask = std::function<tl::expected<control::Response, std::string>(const control::Request&)>;

  explicit LayerFollower(Ask ask) : ask_(std::move(ask)) {}
  LayerFollower(const LayerFollower&) = delete;  // the copy's listener points here
  LayerFollower& operator=(const LayerFollower&) = delete;

  // Asks until the copy is whole. The bytes of the packets that were taken; or why it cannot go on.
  tl::expected<std::uint64_t, std::string> catch_up();

  // Nothing before the first answer. Another layer than before: the daemon has begun a new one.
  const Replica* copy() const { return copy_ ? &*copy_ : nullptr; }
  // The blocks whose codes changed since the last call.
  std::set<BlockOrdinal> take_changed() { return std::exchange(changed_, {}); }

 private:
  // The bytes taken; whether more is missing is told by `next_key`.
  tl::expected<std::uint64_t, std::string> ask_from(BlockOrdinal first_key,
                                                    std::optional<BlockOrdinal>& next_key);
  void begin_layer(const LayerId& id, Resolution resolution);

  Ask ask_;
  std::optional<Replica> copy_;
  std::set<BlockOrdinal> changed_;
};

}  // namespace warren
