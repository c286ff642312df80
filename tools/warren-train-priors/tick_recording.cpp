// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-train-priors/tick_recording.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/terrain/scan_pipeline.hpp"
#include "tools/warren-bench/scan_sequence.hpp"
#include "tools/world/simulation.hpp"

namespace warren {
namespace {

constexpr std::size_t kScansPerTick = 10;
constexpr Point3f kDown{0.0F, 0.0F, -1.0F};

SelfMapConfig map_config(const MapSetting& setting) {
  SelfMapConfig config;
  config.resolution_m = setting.resolution_m;
  return config;
}

// One map under way, cut into ticks.
class Recorder {
 public:
  explicit Recorder(const MapSetting& setting)
      : setting_(setting), map_(map_config(setting)), pipeline_(TerrainConfig::paper()) {
    filter_.max_range_m = setting.max_range_m;
  }

  void add(const Scan& scan) {
    if (!origin_)
      origin_ = LayerOrigin::snapped(scan.T_map_base.translation, setting_.resolution_m);
    if (!origin_) return;
    const auto prepared =
        preparer_.prepare(scan, filter_, *origin_, setting_.resolution_m, rejected_);
    if (prepared) add(*prepared);
  }
  void add(const LayerScan& scan) {
    pipeline_.run(scan, kDown, map_);
    if (++scans_ % kScansPerTick == 0) tick();
  }
  Ticks finish() {
    tick();
    return std::move(ticks_);
  }

 private:
  void tick() {
    ticks_.push_back(blocks_changed_since(map_, cursor_));
    cursor_ = map_.cursor();
  }

  MapSetting setting_;
  SelfMap map_;
  ScanPipeline pipeline_;
  ScanPreparer preparer_;
  SensorFilter filter_;
  RejectionCounts rejected_{};
  std::optional<LayerOrigin> origin_;
  std::uint32_t cursor_ = 0;
  std::size_t scans_ = 0;
  Ticks ticks_;
};

}  // namespace

tl::expected<std::vector<Ticks>, std::string> record_ticks(
    const world::WorldSpec& spec, double seconds, const std::vector<MapSetting>& settings) {
  const auto world = world::make_world(spec);
  if (!world) return tl::unexpected(world.error());
  world::SimulationSpec simulated;
  simulated.seed = spec.seed;
  simulated.duration_s = seconds;
  simulated.robots.emplace_back().name = "robot-0";
  const world::Simulation simulation(*world, simulated);

  std::vector<std::unique_ptr<Recorder>> recorders;
  for (const MapSetting& setting : settings) {
    recorders.push_back(std::make_unique<Recorder>(setting));
  }
  world::FrameStream frames(simulation, 0);
  while (auto frame = frames.next()) {
    Scan scan;
    scan.T_map_base = Pose::of(frame->T_map_base);
    scan.T_base_sensor = Pose::of(frame->T_base_sensor);
    scan.points_sensor = std::move(frame->points_sensor);
    for (const auto& recorder : recorders) recorder->add(scan);
  }
  std::vector<Ticks> recordings;
  for (const auto& recorder : recorders) recordings.push_back(recorder->finish());
  return recordings;
}

tl::expected<Ticks, std::string> record_cloud(const std::filesystem::path& cloud,
                                              const MapSetting& setting) {
  const auto sequence =
      load_sequence({cloud, std::nullopt}, setting.resolution_m, setting.max_range_m);
  if (!sequence) return tl::unexpected(sequence.error());
  Recorder recorder(setting);
  for (std::size_t i = 0; i < sequence->scans.size(); ++i) recorder.add(sequence->scan(i));
  return recorder.finish();
}

Ticks merge_ticks(const Ticks& ticks, std::size_t count) {
  Ticks merged;
  for (std::size_t first = 0; first < ticks.size(); first += count) {
    std::map<BlockOrdinal, CodeBlock> latest;
    for (std::size_t i = first; i < std::min(ticks.size(), first + count); ++i) {
      for (const CodedBlock& coded : ticks[i]) latest.insert_or_assign(coded.block, coded.codes);
    }
    Tick& tick = merged.emplace_back();
    for (auto& [block, codes] : latest) tick.push_back({block, std::move(codes)});
  }
  return merged;
}

void send_ticks(const Ticks& ticks, const SenderRules& rules, bool snapshot,
                const PacketSink& sink) {
  Replica layer(LayerId{1, 1, 1}, kDefaultResolution);
  Publisher publisher(rules);
  const auto send_since = [&](Revision from) {
    for_each_packet(layer, {{}, from}, [&](const DiffPacket& packet) {
      sink(packet.bytes);
      return true;
    });
  };
  for (const Tick& tick : ticks) {
    const Revision from = layer.holdings().at(0);
    layer.publish(publisher.tick(tick, layer));
    if (!snapshot) send_since(from);
  }
  if (snapshot) send_since({});
}

}  // namespace warren
