// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/layer/replica.hpp"
#include "core/voxel/self_map.hpp"
#include "daemon/store/store.hpp"
#include "tests/core/layer/random_codes.hpp"

namespace warren::test {

// What a node would write in the course of time, made up: a self-map that grows, its layer, a copy
// of another's that comes in by packets, items, counters, states. The same seed gives the same
// steps, so whatever a store should hold can be made again by as many steps.
class StoreScenario {
 public:
  explicit StoreScenario(std::uint32_t seed);
  static StoreScenario after(std::uint32_t seed, std::uint64_t steps);

  // What became since the step before; its number is in the counter "step".
  StoreBatch step();
  std::uint64_t steps() const { return steps_; }

  // What in the store is not as it should be after these steps; empty: nothing.
  std::string difference(Store& store) const;

  const Replica& own() const { return own_; }
  const Replica& copy() const { return copy_; }
  const SelfMap& self_map() const { return self_map_; }

 private:
  std::vector<CodedBlock> some_blocks();
  void map_something();
  void hear_something();
  SelfLayerWrite self_write(std::uint32_t before) const;
  LayerWrite copy_write();
  void log_something(StoreBatch& batch);
  std::string layer_difference(Store& store, const Replica& expected, bool own) const;
  std::string self_difference(Store& store) const;

  Random random_;
  std::uint64_t steps_ = 0;
  SelfMap self_map_{SelfMapConfig{}};
  Replica own_;
  Replica theirs_;
  Replica copy_;
  std::vector<Claim> heard_;
  std::vector<KeyInterval> forgotten_;
  std::uint64_t sequence_ = 0;
  std::map<LogItemId, LogItem> items_;
  std::map<std::string, std::uint64_t> counters_;
  std::map<std::string, std::vector<std::uint8_t>> states_;
};

// The steps that a store has seen, by its own account.
std::uint64_t steps_in(Store& store);

}  // namespace warren::test
