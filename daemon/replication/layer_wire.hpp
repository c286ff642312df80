// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/layer/holdings.hpp"
#include "transport/wire/packet_reader.hpp"
#include "transport/wire/packet_writer.hpp"

namespace warren::replication {

inline constexpr std::size_t kLayerIdBytes = 16;

// Some of the keys: intervals in order, not empty, not touching.
struct KeySet {
  static constexpr std::size_t kIntervalsMax = 16;
  std::vector<KeyInterval> intervals{KeyInterval{}};

  bool is_everything() const { return intervals.size() == 1 && intervals[0] == KeyInterval{}; }
  friend bool operator==(const KeySet&, const KeySet&) = default;
};

void write(mesh::PacketWriter& to, const LayerId& id);
void write(mesh::PacketWriter& to, const Holdings& holdings);
void write(mesh::PacketWriter& to, const KeySet& keys);
// Nothing if the bytes are none that write() makes.
std::optional<LayerId> read_layer_id(mesh::PacketReader& from);
std::optional<Holdings> read_holdings(mesh::PacketReader& from);
std::optional<KeySet> read_key_set(mesh::PacketReader& from);

}  // namespace warren::replication
