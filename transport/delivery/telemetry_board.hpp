// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "transport/wire/frames.hpp"

namespace warren::mesh {

// The latest value of each key: one board per node, read by the outboxes of all peers.
class TelemetryBoard {
 public:
  static constexpr std::size_t kKeysMax = 640;

  struct Value {
    std::uint32_t version = 0;
    std::vector<std::uint8_t> bytes;
  };

  // False, and nothing changes, if the value is too large or there are too many keys. Tell the
  // outboxes: Outbox::on_telemetry(key).
  bool set(std::uint16_t key, std::span<const std::uint8_t> bytes);
  const std::map<std::uint16_t, Value>& values() const { return values_; }

 private:
  std::map<std::uint16_t, Value> values_;
};

}  // namespace warren::mesh
