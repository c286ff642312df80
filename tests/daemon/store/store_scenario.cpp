// SPDX-License-Identifier: Apache-2.0
#include "tests/daemon/store/store_scenario.hpp"

#include <algorithm>
#include <set>

namespace warren::test {
namespace {

constexpr std::uint32_t kOwnNode = 1;
constexpr std::uint32_t kOtherNode = 2;

std::vector<std::uint8_t> some_bytes(Random& random, std::uint32_t most) {
  std::vector<std::uint8_t> bytes(1 + below(random, most));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

Pose some_pose(Random& random) {
  const double angle = below(random, 628) / 100.0;
  return {Eigen::Vector3d(below(random, 100), below(random, 100), 1.5),
          Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()))};
}

// All that a store must have kept of a layer.
std::map<BlockOrdinal, std::pair<std::uint32_t, BlockCodes>> content_of(const Replica& layer) {
  std::map<BlockOrdinal, std::pair<std::uint32_t, BlockCodes>> content;
  layer.for_each_changed({}, {}, [&](BlockOrdinal ordinal, const LayerBlock& block) {
    content[ordinal] = {block.history.latest().number, block.codes.unpack()};
    return true;
  });
  return content;
}

// A cost's information may have grown since its block was written: that alone is no change that a
// self-map tells of.
bool equal_but_for_information(const std::optional<BlockState>& stored,
                               std::optional<BlockState> expected) {
  if (!stored || !expected || stored->costs.size() != expected->costs.size()) return false;
  for (std::size_t i = 0; i < stored->costs.size(); ++i) {
    if (stored->costs[i].information > expected->costs[i].information) return false;
    expected->costs[i].information = stored->costs[i].information;
  }
  return *stored == *expected;
}

}  // namespace

StoreScenario::StoreScenario(std::uint32_t seed)
    : random_(seed),
      own_({kOwnNode, 0, 1000 + seed}, kDefaultResolution),
      theirs_({kOtherNode, 3, 2000 + seed}, kDefaultResolution),
      copy_(theirs_.id(), kDefaultResolution) {}

StoreScenario StoreScenario::after(std::uint32_t seed, std::uint64_t steps) {
  StoreScenario scenario(seed);
  while (scenario.steps() < steps) scenario.step();
  return scenario;
}

std::vector<CodedBlock> StoreScenario::some_blocks() {
  std::map<BlockOrdinal, CodeBlock> blocks;
  for (std::uint32_t count = below(random_, 5); count > 0; --count) {
    const auto axis = [&] { return static_cast<std::int32_t>(below(random_, 12)) - 6; };
    const BlockOrdinal block = ordinal_of({axis(), axis(), axis() / 3});
    const bool emptied = chance(random_, 10);
    blocks[block] = emptied ? CodeBlock() : CodeBlock(random_codes(random_, below(random_, 100)));
  }
  std::vector<CodedBlock> coded;
  for (const auto& [block, codes] : blocks) coded.push_back({block, codes});
  return coded;
}

void StoreScenario::map_something() {
  const auto metres = [&](double reach) {
    return static_cast<float>((below(random_, 1000) / 500.0 - 1.0) * reach);
  };
  std::vector<Point3f> points;
  std::vector<VoxelCost> costs;
  std::set<VoxelKey> judged;
  for (std::uint32_t count = below(random_, 6); count > 0; --count) {
    points.push_back({metres(2.0), metres(2.0), metres(0.5)});
    const VoxelKey key = *self_map_.lattice().key_of(points.back());
    if (chance(random_, 50) && judged.insert(key).second) {
      costs.push_back({key, static_cast<float>(below(random_, 100)) / 100.0F, 0.8F});
    }
  }
  self_map_.integrate({{0.01F, 0.02F, 0.03F}, points, std::nullopt, {}});
  self_map_.fuse_costs(costs);
}

void StoreScenario::hear_something() {
  theirs_.publish(some_blocks());
  if (chance(random_, 30)) {
    theirs_.pose().update_origin(
        {theirs_.pose().origin().revision + 1, kOtherNode, some_pose(random_)});
    copy_.pose().update_origin(theirs_.pose().origin());
  }
  const KeyInterval region = keys_of_region(region_of(ordinal_of({0, 0, 0})));
  if (chance(random_, 5) && copy_.forget(region)) forgotten_.push_back(region);
  const KeyInterval keys = chance(random_, 50) ? KeyInterval{} : region;
  const Revision from = copy_.holdings().lowest(keys);
  for_each_packet(theirs_, {keys, from, kPacketBytesMin}, [&](const DiffPacket& packet) {
    if (chance(random_, 30)) return true;  // lost
    if (copy_.apply(theirs_.id(), packet.bytes) == ApplyResult::kApplied) {
      heard_.push_back(packet.claim);
    }
    return true;
  });
}

SelfLayerWrite StoreScenario::self_write(std::uint32_t before) const {
  SelfLayerWrite write;
  write.head = {0,
                77,
                LayerOrigin{8, -16, 0},
                self_map_.config(),
                steps_,
                self_map_.cursor(),
                Pose{},
                {0.0, 0.0, -1.0}};
  for (const BlockKey& key : self_map_.blocks_changed_since(before)) {
    write.blocks.push_back(*self_map_.export_block(key));
  }
  return write;
}

LayerWrite StoreScenario::copy_write() {
  LayerWrite write = write_of(copy_, false, heard_);
  write.forgotten = forgotten_;
  heard_.clear();
  forgotten_.clear();
  return write;
}

void StoreScenario::log_something(StoreBatch& batch) {
  const bool own = chance(random_, 50);
  LogItem item{{{own ? kOwnNode : kOtherNode}, own ? 5U : 6U, ++sequence_},
               own,
               static_cast<std::uint16_t>(below(random_, 3)),
               std::nullopt,
               {},
               some_bytes(random_, 200)};
  if (chance(random_, 50)) item.destination = MemberId{9};
  batch.items.push_back(item);
  items_[item.id] = item;
  for (auto& [id, known] : items_) {
    if (!chance(random_, 10)) continue;
    const MemberId from{below(random_, 12)};
    batch.receipts.push_back({id, from});
    if (!std::count(known.receipts.begin(), known.receipts.end(), from)) {
      known.receipts.push_back(from);
      std::sort(known.receipts.begin(), known.receipts.end());
    }
  }
  if (items_.size() < 8) return;
  batch.erased_items.push_back(items_.begin()->first);
  items_.erase(items_.begin());
}

StoreBatch StoreScenario::step() {
  ++steps_;
  const std::uint32_t cursor = self_map_.cursor();
  const Revision before = own_.holdings().at(0);
  map_something();
  own_.publish(some_blocks());
  if (chance(random_, 20)) {
    own_.pose().update_origin({own_.pose().origin().revision + 1, kOwnNode, some_pose(random_)});
  }
  hear_something();

  StoreBatch batch;
  batch.self_layers.push_back(self_write(cursor));
  std::vector<Claim> told;
  if (before < own_.holdings().at(0)) told.push_back({{}, before, own_.holdings().at(0)});
  batch.layers.push_back(write_of(own_, true, told));
  batch.layers.push_back(copy_write());
  if (chance(random_, 60)) log_something(batch);
  batch.counters = {{"step", steps_},
                    {std::string("n").append(std::to_string(below(random_, 5))), steps_}};
  batch.states["transport"] = some_bytes(random_, 3000);
  if (chance(random_, 20)) batch.states["now and then"] = some_bytes(random_, 10);
  if (chance(random_, 10)) batch.states["now and then"] = {};
  for (const auto& [name, value] : batch.counters) counters_[name] = value;
  for (const auto& [name, state] : batch.states) states_[name] = state;
  std::erase_if(states_, [](const auto& state) { return state.second.empty(); });
  return batch;
}

std::string StoreScenario::layer_difference(Store& store, const Replica& expected, bool own) const {
  for (const StoredLayer& stored : store.layers()) {
    if (stored.head.id != expected.id()) continue;
    const auto replica = store.replica(stored.head);
    if (!replica) return "a layer cannot be read: " + replica.error().text;
    if (stored.head.own != own) return "an own layer is another's, or the reverse";
    if (!(replica->holdings() == expected.holdings())) return "holdings differ";
    if (!(replica->pose() == expected.pose())) return "poses differ";
    if (replica->digest().root() != expected.digest().root()) return "digests differ";
    return content_of(*replica) == content_of(expected) ? "" : "codes or ages differ";
  }
  return steps_ == 0 ? "" : "a layer is missing";
}

std::string StoreScenario::self_difference(Store& store) const {
  const auto heads = store.self_layers();
  if (steps_ == 0) return heads.empty() ? "" : "a self-map too many";
  if (heads.size() != 1) return "not one self-map";
  if (!(heads[0] == self_write(self_map_.cursor()).head)) return "the self-map's head differs";
  const auto map = store.self_map(heads[0]);
  if (!map) return "the self-map cannot be read: " + map.error().text;
  if (map->counts().blocks != self_map_.counts().blocks) return "self-map's blocks differ";
  for (const BlockKey& key : self_map_.blocks_changed_since(0)) {
    if (!equal_but_for_information(map->export_block(key), self_map_.export_block(key))) {
      return "a self-map's block differs";
    }
  }
  return "";
}

std::string StoreScenario::difference(Store& store) const {
  for (const auto& found : {self_difference(store), layer_difference(store, own_, true),
                            layer_difference(store, copy_, false)}) {
    if (!found.empty()) return found;
  }
  const auto items = store.items();
  if (!items) return "items cannot be read";
  std::map<LogItemId, LogItem> kept;
  for (const LogItem& item : *items) kept[item.id] = item;
  if (kept != items_) return "items differ";
  if (store.counters() != counters_) return "counters differ";
  return store.states() == states_ ? "" : "states differ";
}

std::uint64_t steps_in(Store& store) {
  auto counters = store.counters();
  return counters ? (*counters)["step"] : 0;
}

}  // namespace warren::test
