// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/self_map.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <unordered_set>

#include "core/voxel/bits.hpp"
#include "core/voxel/ray_path.hpp"
#include "core/voxel/scan_commit.hpp"
#include "core/voxel/scan_marker.hpp"

namespace warren {

// What an integration needs only while it runs; its memory is kept for the next one.
struct SelfMap::Scratch {
  explicit Scratch(const Lattice& lattice) : path(lattice) {}
  ScanMarker marker;
  RayPath path;
  std::vector<Point3f> end_centres;
};

namespace {

struct RayEnd {
  Point3f point;
  bool marks_hit = true;
};

// Where the ray to a point ends: at the point, or at max range, in the oracle's roundings.
RayEnd end_of_ray(const Point3f& origin, const Point3f& point, std::optional<double> max_range_m) {
  if (!max_range_m) return {point, true};
  Point3f d{point.x - origin.x, point.y - origin.y, point.z - origin.z};
  const double length = std::sqrt(static_cast<double>(d.x * d.x + d.y * d.y + d.z * d.z));
  if (length <= *max_range_m) return {point, true};
  const auto divisor = static_cast<float>(length);
  const auto range = static_cast<float>(*max_range_m);
  return {{origin.x + d.x / divisor * range, origin.y + d.y / divisor * range,
           origin.z + d.z / divisor * range},
          false};
}

// Why a point has no voxel.
Rejection reason_outside(const Point3f& point) {
  if (std::isnan(point.x) || std::isnan(point.y) || std::isnan(point.z)) {
    return Rejection::kNoReturn;
  }
  return is_finite(point) ? Rejection::kOutsideKeySpace : Rejection::kInfinite;
}

// Marks one scan: all hits, then all passes.
class ScanTracer {
 public:
  ScanTracer(const Lattice& lattice, const LayerScan& scan, const VoxelKey& origin,
             IntegrationReport& report)
      : lattice_(lattice), scan_(scan), origin_(origin), report_(report) {}

  void mark_hits(std::span<const Point3f> points, ScanMarker& marker) {
    for (const Point3f& point : points) {
      const RayEnd end = end_of_ray(scan_.origin_layer, point, scan_.max_range_m);
      if (!end.marks_hit) continue;
      if (const auto key = lattice_.key_of(end.point)) marker.hit(*key);
    }
  }

  void mark_passes(std::span<const Point3f> points, RayPath& path, ScanMarker& marker) {
    for (const Point3f& point : points) {
      const RayEnd end = end_of_ray(scan_.origin_layer, point, scan_.max_range_m);
      const auto key = lattice_.key_of(end.point);
      if (!key) {
        ++count_of(report_.rejected, reason_outside(point));
        continue;
      }
      ++report_.rays;
      marker.pass(path, path.trace(scan_.origin_layer, origin_, end.point, *key));
    }
  }

 private:
  const Lattice& lattice_;
  const LayerScan& scan_;
  VoxelKey origin_;
  IntegrationReport& report_;
};

// One point per end voxel, its centre, in order of first appearance.
void reduce_to_end_voxels(const Lattice& lattice, std::span<const Point3f> points,
                          IntegrationReport& report, std::vector<Point3f>& centres) {
  centres.clear();
  std::unordered_set<std::uint64_t> seen;
  for (const Point3f& point : points) {
    const auto key = lattice.key_of(point);
    if (!key) {
      ++count_of(report.rejected, reason_outside(point));
      continue;
    }
    const auto code = [](std::int32_t axis) { return static_cast<std::uint64_t>(axis - kKeyMin); };
    if (!seen.insert(code(key->x) << 32 | code(key->y) << 16 | code(key->z)).second) continue;
    centres.push_back(lattice.centre(*key));
  }
}

}  // namespace

SelfMap::SelfMap(const SelfMapConfig& config)
    : config_(config),
      lattice_(config.resolution_m),
      model_(config.sensor_model),
      cost_fusion_(config.cost_fusion),
      scratch_(std::make_unique<Scratch>(lattice_)) {
  assert(config.resolution_m > 0.0 && config.sensor_model.is_valid());
}

SelfMap::~SelfMap() = default;
SelfMap::SelfMap(SelfMap&&) noexcept = default;
SelfMap& SelfMap::operator=(SelfMap&&) noexcept = default;

SelfMap::SelfMap(const SelfMap& other)
    : config_(other.config_),
      lattice_(other.lattice_),
      model_(other.model_),
      cost_fusion_(other.cost_fusion_),
      store_(other.store_),
      scratch_(std::make_unique<Scratch>(lattice_)),
      scans_(other.scans_) {}

SelfMap& SelfMap::operator=(const SelfMap& other) {
  if (this != &other) *this = SelfMap(other);
  return *this;
}

IntegrationReport SelfMap::integrate(const LayerScan& scan) {
  IntegrationReport report;
  ++scans_;
  const auto origin = lattice_.key_of(scan.origin_layer);
  if (!origin) {
    ++count_of(report.rejected, Rejection::kOriginOutsideKeySpace);
    return report;
  }
  std::span<const Point3f> points = scan.points_layer;
  if (config_.one_ray_per_end_voxel) {
    reduce_to_end_voxels(lattice_, points, report, scratch_->end_centres);
    points = scratch_->end_centres;
  }
  ScanMarker& marker = scratch_->marker;
  marker.begin(store_);
  ScanTracer tracer(lattice_, scan, *origin, report);
  tracer.mark_hits(points, marker);
  tracer.mark_passes(points, scratch_->path, marker);
  report.points_used = scan.points_layer.size() - sum(report.rejected);
  tracer.mark_passes(scan.carved_ends_layer, scratch_->path, marker);

  const CommitCounts counts = commit_marks(marker, model_, scans_, store_);
  report.voxels_hit = counts.voxels_hit;
  report.voxels_passed = counts.voxels_passed;
  report.blocks_changed = counts.blocks_changed;
  return report;
}

CostFusionReport SelfMap::fuse_costs(std::span<const VoxelCost> costs) {
  return commit_costs(costs, cost_fusion_, model_, scans_, store_);
}

VoxelState SelfMap::state(const VoxelKey& key) const { return store_.state(key); }

VoxelState SelfMap::state(const Point3f& point_layer) const {
  const auto key = lattice_.key_of(point_layer);
  return key ? store_.state(*key) : VoxelState::kUnknown;
}

std::optional<float> SelfMap::log_odds(const VoxelKey& key) const {
  const auto steps = store_.value(key, model_.minimum);
  if (!steps) return std::nullopt;
  return model_.log_odds(*steps);
}

std::optional<FusedCost> SelfMap::fused_cost(const VoxelKey& key) const {
  const BlockSlot slot = store_.slot_of(block_of(key));
  if (slot < kFirstBlockSlot) return std::nullopt;
  const Block& block = store_.block(slot);
  const std::uint32_t place = morton9(key.x, key.y, key.z);
  if ((block.occupied[place >> 6] >> (place & 63) & 1) == 0) return std::nullopt;
  return store_.cost(block, place);
}

std::optional<float> SelfMap::cost(const VoxelKey& key) const {
  const auto fused = fused_cost(key);
  if (!fused) return std::nullopt;
  return fused->value();
}

std::vector<BlockKey> SelfMap::blocks_changed_since(std::uint32_t cursor) const {
  std::vector<BlockKey> changed;
  for (std::uint32_t index = 0; index < store_.region_count(); ++index) {
    if (store_.last_changes()[index] <= cursor) continue;
    const Region& region = store_.region(index);
    for (std::uint32_t slot = 0; slot < kBlocksPerRegion; ++slot) {
      if (region.changed_at[slot] > cursor) changed.push_back(block_in_region(region.key, slot));
    }
  }
  return changed;
}

bool SelfMap::import_block(const BlockState& state) {
  if (!state.is_sound() || store_.slot_of(state.key) != kAbsentBlock) return false;
  const std::int16_t* next = state.values.data();
  bool could_be = true;
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    for_each_bit(state.stored(cell), [&](std::uint32_t bit) {
      const std::int16_t value = *next++;
      const bool occupied = (state.occupied[cell] >> bit & 1) != 0;
      could_be =
          could_be && model_.minimum < value && value <= model_.maximum && occupied == (value >= 0);
    });
  }
  if (!could_be) return false;
  store_.import_block(state);
  scans_ = std::max(scans_, state.changed_at);
  return true;
}

std::size_t SelfMap::memory_bytes() const {
  return store_.memory_bytes() + scratch_->marker.memory_bytes() + scratch_->path.memory_bytes() +
         scratch_->end_centres.capacity() * sizeof(Point3f) + sizeof(Scratch);
}

}  // namespace warren
