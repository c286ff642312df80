// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/wire_growth.hpp"

#include <algorithm>
#include <cmath>
#include <list>

#include "core/layer/publisher.hpp"
#include "core/terrain/scan_pipeline.hpp"
#include "tools/warren-bench/stopwatch.hpp"
#include "tools/warren-bench/wire_sweep.hpp"

namespace warren {
namespace {

constexpr Point3f kDown{0.0F, 0.0F, -1.0F};
constexpr double kCopyDistanceM = 128.0;
// The least of so many counts, taken in turn: what else the machine does only ever adds.
constexpr int kRepeats = 3;

struct Cost {
  double publish_ms = 1e300;
  double apply_ms = 1e300;

  void lower_to(const Cost& other) {
    publish_ms = std::min(publish_ms, other.publish_ms);
    apply_ms = std::min(apply_ms, other.apply_ms);
  }
};

// A robot's map, its layer, and a peer's copy of that.
class GrowingMap {
 public:
  GrowingMap(const ScanSequence& sequence, const WireOptions& options)
      : sequence_(sequence),
        options_(options),
        scans_per_tick_(scans_per_tick(sequence, options)),
        map_(options.map) {}

  // Maps the scene once more, far from where it was mapped before.
  Cost add_copy() {
    const ScanSequence moved = sequence_.moved_by({copy_distance_m() * copies_++, 0.0F, 0.0F});
    Stopwatch publishing;
    Stopwatch applying;
    for (std::size_t i = 0; i < moved.scans.size(); ++i) {
      pipeline_.run(moved.scan(i), kDown, map_);
      if (i + 1 != moved.scans.size() && (i + 1) % scans_per_tick_ != 0) continue;
      const Revision from = layer_.holdings().at(0);
      publishing.time([&] { publish(); });
      const auto packets = sweep(layer_, from, options_.packet_bytes);
      applying.time([&] { apply_all(copy_, packets); });
    }
    return {publishing.ms_per(1), applying.ms_per(1)};
  }

 private:
  // Whole regions, so that every copy lies in the layer's blocks alike.
  float copy_distance_m() const {
    const double region_m = kRegionEdge * options_.map.resolution_m;
    return static_cast<float>(std::ceil(kCopyDistanceM / region_m) * region_m);
  }
  void publish() {
    layer_.publish(publisher_.tick(blocks_changed_since(map_, cursor_), layer_));
    cursor_ = map_.cursor();
  }

  const ScanSequence& sequence_;
  WireOptions options_;
  std::size_t scans_per_tick_;
  SelfMap map_;
  ScanPipeline pipeline_{TerrainConfig::paper()};
  Publisher publisher_;
  Replica layer_{LayerId{1, 1, 1}, kDefaultResolution};
  Replica copy_{LayerId{1, 1, 1}, kDefaultResolution};
  std::uint32_t cursor_ = 0;
  float copies_ = 0.0F;
};

}  // namespace

WireGrowth bench_growth(const ScanSequence& sequence, const WireOptions& options) {
  GrowingMap grown(sequence, options);
  for (int copy = kRepeats; copy < options.growth_copies; ++copy) grown.add_copy();
  Cost alone;
  Cost last;
  // None gives its memory back before the end, so that each lays its blocks into fresh memory.
  std::list<GrowingMap> maps_of_one;
  for (int i = 0; i < kRepeats; ++i) {
    alone.lower_to(maps_of_one.emplace_back(sequence, options).add_copy());
    last.lower_to(grown.add_copy());
  }
  return {last.publish_ms / alone.publish_ms, last.apply_ms / alone.apply_ms};
}

}  // namespace warren
