// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/wire_tape.hpp"

#include <algorithm>
#include <cmath>

#include "core/layer/publisher.hpp"
#include "core/terrain/scan_pipeline.hpp"
#include "tools/warren-bench/stopwatch.hpp"

namespace warren {
namespace {

constexpr Point3f kGravity{0.0F, 0.0F, -1.0F};
// A tick of 1 s at 10 Hz, whatever the tick of the tape.
constexpr std::size_t kScansPerPublishing = 10;

// Publishes a growing self-map into a layer of its own and times that.
class TimedPublisher {
 public:
  void tick(const SelfMap& map) {
    watch_.time([&] {
      layer_.publish(publisher_.tick(blocks_changed_since(map, cursor_), layer_));
      cursor_ = map.cursor();
    });
  }
  double ms() const { return watch_.ms_per(1); }

 private:
  Stopwatch watch_;
  Publisher publisher_;
  Replica layer_{LayerId{1, 1, 1}, kDefaultResolution};
  std::uint32_t cursor_ = 0;
};

double rate_of(const ScanSequence& sequence, double rate_hz) {
  const auto& scans = sequence.scans;
  const auto timed = [](const ScanSequence::Item& scan) { return scan.time_s.has_value(); };
  if (scans.size() < 2 || !std::all_of(scans.begin(), scans.end(), timed)) return rate_hz;
  const double seconds = *scans.back().time_s - *scans.front().time_s;
  return seconds > 0.0 ? static_cast<double>(scans.size() - 1) / seconds : rate_hz;
}

}  // namespace

std::size_t scans_per_tick(const ScanSequence& sequence, const WireOptions& options) {
  const double scans = options.tick_s * rate_of(sequence, options.rate_hz);
  return static_cast<std::size_t>(std::max(1.0, std::round(scans)));
}

WireTape record_wire_tape(const ScanSequence& sequence, const WireOptions& options) {
  WireTape tape;
  tape.scans_per_tick = scans_per_tick(sequence, options);
  SelfMap map(options.map);
  ScanPipeline pipeline(TerrainConfig::paper());
  TimedPublisher publishing;
  Stopwatch integrating;
  std::uint32_t cursor = 0;
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) {
    integrating.time([&] { pipeline.run(sequence.scan(i), kGravity, map); });
    const bool last = i + 1 == sequence.scans.size();
    if (last || (i + 1) % kScansPerPublishing == 0) publishing.tick(map);
    if (!last && (i + 1) % tape.scans_per_tick != 0) continue;
    tape.ticks.push_back(blocks_changed_since(map, cursor));
    cursor = map.cursor();
  }
  const double integrating_ms = integrating.ms_per(1);
  tape.publish_share = integrating_ms > 0.0 ? publishing.ms() / integrating_ms : 0.0;
  return tape;
}

}  // namespace warren
