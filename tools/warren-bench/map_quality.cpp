// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/map_quality.hpp"

#include <algorithm>
#include <set>
#include <span>

#include "core/voxel/self_map.hpp"
#include "tools/warren-bench/nearest_point.hpp"
#include "tools/world/simulation.hpp"
#include "tools/world/truth/visible_cloud.hpp"
#include "tools/world/truth/voxel_labels.hpp"

namespace warren {
namespace {

constexpr double kSampleSpacingM = 0.05;
constexpr double kViewpointSpacingM = 0.5;
constexpr double kCableRangeM =
    10.0;  // farther off a beam meets a cable too rarely to be asked for

struct Candidate {
  NamedModel model;
  SelfMap map;
};

// Maps in the world's own frame: its lattice is then that of the labels.
Scan scan_of(const world::Frame& frame) {
  Scan scan;
  scan.T_map_base = {frame.T_world_base.translation(),
                     Eigen::Quaterniond(frame.T_world_base.linear())};
  scan.T_base_sensor = {frame.T_base_sensor.translation(),
                        Eigen::Quaterniond(frame.T_base_sensor.linear())};
  scan.points_sensor = frame.points_sensor;
  return scan;
}

void map_all(const world::Simulation& simulation, double max_range_m,
             std::vector<Candidate>& candidates) {
  SensorFilter filter;
  filter.min_range_m = 0.3;
  filter.max_range_m = max_range_m;
  ScanPreparer preparer;
  RejectionCounts rejected{};
  world::FrameStream frames(simulation, 0);
  while (const auto frame = frames.next()) {
    const Scan scan = scan_of(*frame);
    for (Candidate& candidate : candidates) {
      const auto prepared =
          preparer.prepare(scan, filter, {}, candidate.map.config().resolution_m, rejected);
      if (prepared) candidate.map.integrate(*prepared);
    }
  }
}

// What could be known of a world by one robot's way through it.
class Truth {
 public:
  Truth(const world::Simulation& simulation, double max_range_m)
      : samples_(world::sample_surface(simulation.world().mesh, kSampleSpacingM,
                                       world::Random(simulation.spec().seed))),
        surface_(positions(samples_)) {
    const auto viewpoints = world::viewpoints_of(simulation, 0, kViewpointSpacingM);
    const auto& lidar = simulation.spec().robots[0].lidar;
    const world::Sight sight(simulation.caster(), viewpoints, world::field_of(lidar, max_range_m));
    visible_ = world::visible_part(samples_, sight);
    const world::Sight near_sight(simulation.caster(), viewpoints,
                                  world::field_of(lidar, std::min(kCableRangeM, max_range_m)));
    std::vector<world::SurfaceSample> cables;
    std::copy_if(visible_.begin(), visible_.end(), std::back_inserter(cables),
                 [](const auto& sample) { return sample.surface == world::Surface::kCable; });
    cables_ = world::visible_part(cables, near_sight);
  }

  float to_surface_m(const Eigen::Vector3f& from) const { return surface_.distance_m(from); }
  std::span<const world::SurfaceSample> visible() const { return visible_; }
  std::span<const world::SurfaceSample> cables() const { return cables_; }

 private:
  static std::vector<Eigen::Vector3f> positions(std::span<const world::SurfaceSample> samples) {
    std::vector<Eigen::Vector3f> all;
    all.reserve(samples.size());
    for (const auto& sample : samples) all.push_back(sample.position);
    return all;
  }

  std::vector<world::SurfaceSample> samples_;
  NearestPoint surface_;
  std::vector<world::SurfaceSample> visible_;
  std::vector<world::SurfaceSample> cables_;
};

double share(std::size_t part, std::size_t all) {
  return all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all);
}

std::vector<Eigen::Vector3f> occupied_centres(const SelfMap& map) {
  std::vector<Eigen::Vector3f> centres;
  const Lattice& lattice = map.lattice();
  map.for_each_known_voxel(KeyBox{}, [&](const VoxelKey& key, VoxelState state, float) {
    if (state != VoxelState::kOccupied) return;
    centres.emplace_back(static_cast<float>(lattice.centre_m(key.x)),
                         static_cast<float>(lattice.centre_m(key.y)),
                         static_cast<float>(lattice.centre_m(key.z)));
  });
  return centres;
}

// Distances, counted by the thresholds of the report.
class DistanceCounts {
 public:
  void add(double distance_m) {
    ++all_;
    for (std::size_t i = 0; i < kQualityDistancesM.size(); ++i) {
      if (distance_m <= kQualityDistancesM[i]) ++within_[i];
    }
  }
  double share_within(std::size_t i) const { return share(within_[i], all_); }
  double share_beyond(std::size_t i) const { return all_ == 0 ? 0.0 : 1.0 - share_within(i); }

 private:
  std::size_t all_ = 0;
  std::array<std::size_t, kQualityDistancesM.size()> within_{};
};

std::set<VoxelKey> voxels_of(const Lattice& lattice,
                             std::span<const world::SurfaceSample> samples) {
  std::set<VoxelKey> voxels;
  for (const auto& sample : samples) {
    const auto key = lattice.key_of(sample.position.x(), sample.position.y(), sample.position.z());
    if (key) voxels.insert(*key);
  }
  return voxels;
}

struct StateShares {
  double occupied = 0.0;
  double free = 0.0;
};
StateShares state_shares(const SelfMap& map, const std::set<VoxelKey>& voxels) {
  std::size_t occupied = 0;
  std::size_t free = 0;
  for (const VoxelKey& key : voxels) {
    const VoxelState state = map.state(key);
    if (state == VoxelState::kOccupied) ++occupied;
    if (state == VoxelState::kFree) ++free;
  }
  return {share(occupied, voxels.size()), share(free, voxels.size())};
}

double precision(const std::vector<Eigen::Vector3f>& centres, const world::VoxelLabels& labels) {
  const auto right = std::count_if(centres.begin(), centres.end(), [&](const auto& centre) {
    return labels.at(labels.index_of(centre.template cast<double>())) ==
           world::VoxelTruth::kSurface;
  });
  return share(static_cast<std::size_t>(right), centres.size());
}

MapQuality judge(const Candidate& candidate, const Truth& truth, const world::VoxelLabels& labels) {
  const SelfMap& map = candidate.map;
  const auto centres = occupied_centres(map);
  const NearestPoint nearest(centres);
  DistanceCounts covered;
  for (const auto& sample : truth.visible()) covered.add(nearest.distance_m(sample.position));
  DistanceCounts deviating;
  for (const Eigen::Vector3f& centre : centres) deviating.add(truth.to_surface_m(centre));

  MapQuality quality;
  quality.model = candidate.model.name;
  quality.resolution_m = map.config().resolution_m;
  for (std::size_t i = 0; i < kQualityDistancesM.size(); ++i) {
    quality.coverage[i] = covered.share_within(i);
    quality.deviation[i] = deviating.share_beyond(i);
  }
  const StateShares surface = state_shares(map, voxels_of(map.lattice(), truth.visible()));
  quality.occupied_precision = precision(centres, labels);
  quality.occupied_recall = surface.occupied;
  quality.false_free = surface.free;
  const auto cable_voxels = voxels_of(map.lattice(), truth.cables());
  quality.cable_voxels = cable_voxels.size();
  if (!cable_voxels.empty()) quality.cable_recall = state_shares(map, cable_voxels).occupied;
  quality.map_points = centres.size();
  quality.voxels_free = map.counts().free;
  return quality;
}

std::vector<MapQuality> judge_world(const world::World& world, const MapQualityOptions& options) {
  world::SimulationSpec spec;
  spec.seed = options.seed;
  spec.duration_s = options.duration_s;
  spec.robots.emplace_back();
  const world::Simulation simulation(world, spec);
  const Truth truth(simulation, options.max_range_m);
  std::vector<MapQuality> results;
  for (const double resolution_m : options.resolutions_m) {
    std::vector<Candidate> candidates;
    for (const NamedModel& model : options.models) {
      candidates.push_back({model, SelfMap({resolution_m, model.model, false})});
    }
    map_all(simulation, options.max_range_m, candidates);
    const world::VoxelLabels labels(world.mesh, resolution_m);
    for (const Candidate& candidate : candidates) {
      results.push_back(judge(candidate, truth, labels));
      results.back().world = world.name;
    }
  }
  return results;
}

}  // namespace

tl::expected<std::vector<MapQuality>, std::string> bench_map_quality(
    const MapQualityOptions& options) {
  std::vector<MapQuality> results;
  for (const std::string& name : options.worlds) {
    const auto world = world::make_world({name, options.seed, 0.0});
    if (!world) return tl::unexpected(world.error());
    const auto judged = judge_world(*world, options);
    results.insert(results.end(), judged.begin(), judged.end());
  }
  return results;
}

}  // namespace warren
