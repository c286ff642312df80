// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>

#include "daemon/fleet/blocks_answer.hpp"
#include "tests/core/layer/random_codes.hpp"
#include "tests/daemon/block_copy.hpp"
#include "tests/daemon/small_fleet.hpp"

namespace warren {

using namespace test;

namespace {

using Known = std::map<VoxelKey, std::uint8_t>;

Known merged(FleetMap& fleet) {
  Known voxels;
  fleet.merged_snapshot()->for_each_known(
      [&](const VoxelKey& key, VoxelCode code, SourceNumber) { voxels[key] = code.bits(); });
  return voxels;
}

Known published(const FleetMap& fleet) {
  Known voxels;
  const Replica& layer = fleet.own_layers().rbegin()->second.layer();
  layer.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
    const VoxelKey first = first_voxel_of(block_key_of(block));
    found.codes.for_each_known([&](std::uint32_t place, VoxelCode code) {
      const VoxelKey at = place_of_morton9(place);
      voxels[{first.x + at.x, first.y + at.y, first.z + at.z}] = code.bits();
    });
    return true;
  });
  return voxels;
}

// Asks as the protocol says, and keeps the copy.
struct Subscriber {
  BlocksQuestion question;
  BlockCopy copy{};
  int begun = 0;  // how often from nothing

  // Whether there is more.
  bool ask(FleetMap& fleet) {
    const auto answer = fleet.blocks(question);
    REQUIRE(answer.has_value());
    REQUIRE(answer->keys.size() <= BlocksAnswer::kBlocksMax);
    REQUIRE(answer->codes.size() + 3 * answer->keys.size() <= question.most_bytes);
    REQUIRE(copy.apply(answer->anew, answer->keys, answer->codes));
    begun += answer->anew ? 1 : 0;
    question.cursor = decode_cursor(encode_cursor(answer->cursor));
    REQUIRE(question.cursor == answer->cursor);
    return answer->is_part();
  }
  void catch_up(FleetMap& fleet) {
    for (int asked = 0; ask(fleet); ++asked) REQUIRE(asked < 100'000);
  }
};

Subscriber subscriber(MapSource source, std::size_t most_bytes = 262144) {
  Subscriber subscriber;
  subscriber.question.source = source;
  subscriber.question.most_bytes = most_bytes;
  return subscriber;
}

// A fleet thread's map in which anything may happen.
class BusyFleet {
 public:
  explicit BusyFleet(std::uint64_t seed) : random_(seed) { publish(); }

  FleetMap& map() { return map_; }
  void step() {
    const std::uint32_t event = below(random_, 20);
    if (event < 8) return publish();
    if (event < 10) return shift_map_frame();
    if (event == 10) return begin_layer();
    if (event == 11) return load();
    if (loaded_.empty()) return;
    const LayerId id = loaded_[below(random_, static_cast<std::uint32_t>(loaded_.size()))];
    if (event < 15) {
      REQUIRE(map_.loaded().move(id, random_shift()).has_value());
    } else if (event < 18) {
      REQUIRE(map_.loaded().retract(id).has_value());
    } else {
      REQUIRE(map_.loaded().restore(id).has_value());
    }
  }

 private:
  std::vector<CodedBlock> random_blocks() {
    std::map<BlockOrdinal, CodedBlock> blocks;
    for (std::uint32_t count = 1 + below(random_, 12); count > 0; --count) {
      const auto axis = [&] { return static_cast<std::int32_t>(below(random_, 12)) - 6; };
      const BlockOrdinal block = ordinal_of({axis(), axis(), axis() / 3});
      blocks[block] = {block, CodeBlock(random_codes(random_, 30))};
    }
    std::vector<CodedBlock> list;
    for (const auto& [block, coded] : blocks) list.push_back(coded);
    return list;
  }
  LayerShift random_shift() {
    const auto metres = [&] { return 0.1 * (static_cast<double>(below(random_, 80)) - 40.0); };
    return {{metres(), metres(), 0.0}, chance(random_, 50) ? 0.0 : 0.3};
  }
  void publish() {
    LayerChanges changes = changes_of(random_blocks(), number_);
    changes.T_fleet_map.translation = shift_;
    map_.tick({&changes, 1});
  }
  void shift_map_frame() {
    shift_ = random_shift().shift_fleet_m;
    publish();
  }
  void begin_layer() {
    ++number_;
    publish();
  }
  void load() {
    if (loaded_.size() == 4) return;
    Replica layer(LayerId{99, static_cast<std::uint32_t>(loaded_.size()), 5}, kDefaultResolution);
    layer.publish(random_blocks());
    const Eigen::Vector3d origin = kFarOrigin.position_map(0.1);
    layer.pose().update_origin({1, 99, {origin, Eigen::Quaterniond::Identity()}});
    loaded_.push_back(layer.id());
    REQUIRE(map_.load(std::move(layer), "old.layer").has_value());
  }

  Random random_;
  FleetMap map_ = fleet_map({false, false}, 3);
  std::uint32_t number_ = 0;
  Eigen::Vector3d shift_ = Eigen::Vector3d::Zero();
  std::vector<LayerId> loaded_;
};

}  // namespace

TEST_CASE("a copy equals the map once its subscriber has caught up, whatever happened meanwhile") {
  std::size_t compared = 0;
  int begun = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    BusyFleet fleet(seed);
    Subscriber merge = subscriber(MapSource::kMerge, BlocksQuestion::kBytesMin);
    Subscriber self = subscriber(MapSource::kSelf, BlocksQuestion::kBytesMin);
    for (int step = 0; step < 60; ++step) {
      fleet.step();
      // Mostly too slow to get through before the next change.
      merge.ask(fleet.map());
      self.ask(fleet.map());
      if (step % 10 != 9) continue;
      merge.catch_up(fleet.map());
      self.catch_up(fleet.map());
      REQUIRE(merge.copy.known() == merged(fleet.map()));
      REQUIRE(self.copy.known() == published(fleet.map()));
      compared += merge.copy.blocks();
    }
    begun += merge.begun;
  }
  CHECK(compared > 2000);
  CHECK(begun > 12);  // new own layers were among the events
}

TEST_CASE("a subscriber who has everything is told nothing, and only what changed afterwards") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 3), floor_block({1, 0, 0}, 3)});
  for (const MapSource source : {MapSource::kSelf, MapSource::kMerge}) {
    BlocksQuestion question;
    question.source = source;
    const auto first = fleet.blocks(question);
    REQUIRE(first.has_value());
    CHECK(first->anew);
    CHECK(first->keys == std::vector<BlockKey>{{0, 0, 0}, {1, 0, 0}});
    CHECK_FALSE(first->is_part());
    question.cursor = first->cursor;
    CHECK_FALSE(fleet.blocks(question)->is_news());
    tick(fleet, {floor_block({1, 0, 0}, source == MapSource::kSelf ? 9 : 15)});
    const auto second = fleet.blocks(question);
    CHECK_FALSE(second->anew);
    CHECK(second->keys == std::vector<BlockKey>{{1, 0, 0}});
  }
}

TEST_CASE("blocks of a box are those that it touches, and a box beyond all keys has none") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 3), floor_block({1, 0, 0}, 3), floor_block({2, 0, 0}, 3)});
  const Eigen::Vector3d origin = kFarOrigin.position_map(0.1);
  const auto keys_in = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    BlocksQuestion question;
    question.box = MapBox{origin + low, origin + high};
    question.source = MapSource::kMerge;
    const auto merge = fleet.blocks(question)->keys;
    question.source = MapSource::kSelf;
    CHECK(fleet.blocks(question)->keys == merge);
    return merge;
  };
  using Keys = std::vector<BlockKey>;
  CHECK(keys_in({0.9, 0.1, 0.1}, {1.5, 0.2, 0.2}) == Keys{{1, 0, 0}});
  CHECK(keys_in({0.7, 0.1, 0.1}, {0.9, 0.2, 0.2}) == Keys{{0, 0, 0}, {1, 0, 0}});
  CHECK(keys_in({-1e15, -1e15, -1e15}, {1e15, 1e15, 1e15}).size() == 3);
  CHECK(keys_in({1e9, 0.0, 0.0}, {1e10, 1.0, 1.0}).empty());
  CHECK(keys_in({-1e10, 0.0, 0.0}, {-1e9, 1.0, 1.0}).empty());
}

TEST_CASE("what leaves the map is told as unknown, and a copy of a forgotten past begins anew") {
  FleetMap fleet = fleet_map();
  tick(fleet, {floor_block({0, 0, 0}, 3)});
  std::vector<CodedBlock> far;
  for (std::int32_t x = 1; x <= 400; ++x) far.push_back(floor_block({8 * x, 0, 0}, 5));
  const LayerId id = fleet.load(earlier_layer(far), "old.layer")->id;
  Subscriber merge = subscriber(MapSource::kMerge);
  merge.catch_up(fleet);
  CHECK(merge.copy.blocks() == 401);
  REQUIRE(fleet.loaded().retract(id).has_value());
  merge.catch_up(fleet);
  CHECK(merge.copy.blocks() == 1);
  CHECK(merge.begun == 1);
  for (const double y_m : {0.0, 6.4, 12.8, 19.2, 25.6}) {
    REQUIRE(fleet.loaded().move(id, {{0.0, y_m, 0.0}, 0.0}).has_value());
    REQUIRE(fleet.loaded().restore(id).has_value());
  }
  merge.catch_up(fleet);
  CHECK(merge.begun == 2);
  CHECK(merge.copy.known() == merged(fleet));
}

TEST_CASE("a cursor of another frame, or from the future, begins anew; so does none") {
  FleetMap fleet = fleet_map();
  CHECK(fleet.blocks({}).error().find("no map yet") != std::string::npos);
  tick(fleet, {floor_block({0, 0, 0}, 3)});
  BlocksQuestion question;
  question.source = MapSource::kMerge;
  const BlocksCursor cursor = fleet.blocks(question)->cursor;
  const auto begins_anew = [&](const std::function<void(BlocksCursor&)>& change) {
    question.cursor = cursor;
    change(*question.cursor);
    const auto answer = fleet.blocks(question);
    CHECK(answer->keys.size() == (answer->anew ? 1 : 0));
    return answer->anew;
  };
  CHECK_FALSE(begins_anew([](BlocksCursor&) {}));
  CHECK(begins_anew([](BlocksCursor& c) { ++c.frame; }));
  CHECK(begins_anew([](BlocksCursor& c) { c.until += 1000; }));
}

TEST_CASE("a frame of 40000 noisy voxels comes back from its runs as it was") {
  Random random(7);
  std::string codes;
  std::vector<BlockKey> keys;
  std::vector<BlockVoxels> blocks;
  for (std::int32_t i = 0; i < 80; ++i) {
    BlockVoxels voxels{};
    const VoxelCode first = random_code(random);
    // From one code for all to a code for each.
    for (VoxelCode& code : voxels) {
      code = chance(random, static_cast<std::uint32_t>(i)) ? random_code(random) : first;
    }
    keys.push_back({i, -i, 3});
    blocks.push_back(voxels);
    const std::size_t before = codes.size();
    append_runs(voxels, codes);
    REQUIRE(codes.size() - before <= kBlockRunsMax);
  }
  BlockCopy copy;
  REQUIRE(copy.apply(false, keys, codes));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const VoxelKey first = first_voxel_of(keys[i]);
    for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
      const VoxelKey at = place_of_morton9(place);
      const VoxelKey key{first.x + at.x, first.y + at.y, first.z + at.z};
      REQUIRE(copy.code(key) == blocks[i][place].bits());
    }
  }
}

TEST_CASE("one code for a whole block is two bytes") {
  BlockVoxels air;
  air.fill(VoxelCode::free());
  std::string codes;
  append_runs(air, codes);
  CHECK(codes == "\x81\xFF");
}

}  // namespace warren
