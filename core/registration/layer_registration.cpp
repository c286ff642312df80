// SPDX-License-Identifier: Apache-2.0
#include "core/registration/layer_registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include <pcl/filters/voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/ndt.h>

#include "core/registration/registration_score.hpp"
#include "core/voxel/morton.hpp"

namespace warren {
namespace {

using Points = pcl::PointCloud<pcl::PointXYZ>;

constexpr double kMargin_m = 4.0;  // how far off what overlaps may lie
constexpr std::size_t kPointsMin = 100;
constexpr std::size_t kPointsMax = 12'000;       // of each layer, for GICP
constexpr std::size_t kCoarsePointsMax = 3'000;  // of the layer, for NDT
constexpr std::size_t kSampleMax = 8'000;        // of the layer, to choose among motions
constexpr double kGridEdge_m = 0.2;              // to begin with
constexpr double kGridGrowth = 1.3;
constexpr std::array kHeadings_deg{0.0, 8.0, -8.0, 16.0, -16.0, 26.0, -26.0};
constexpr float kNdtCell_m = 2.0F;
constexpr double kNdtStep_m = 0.4;
constexpr int kNdtTurns = 30;
constexpr std::array kGicpReach_m{1.0, 0.5};
constexpr int kGicpTurns = 25;
constexpr double kToleranceVoxels = 2.0;

Cloud obstacles_fleet(const Replica& layer) {
  Cloud cloud;
  const double resolution_m = layer.resolution().metres();
  const Eigen::Isometry3d T_fleet_layer = layer.pose().T_fleet_layer();
  layer.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
    found.codes.for_each_known([&](std::uint32_t place, VoxelCode code) {
      if (code.state() != VoxelState::kOccupied) return;
      const VoxelKey key = key_of_morton(block << 9 | place);
      cloud.push_back(
          T_fleet_layer *
          ((Eigen::Vector3d(key.x, key.y, key.z).array() + 0.5) * resolution_m).matrix());
    });
    return true;
  });
  return cloud;
}

// Those of the points that lie in the other cloud's box, or not far outside.
Cloud cropped(const Cloud& cloud, const Cloud& other) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : other) box.extend(point);
  if (box.isEmpty()) return {};
  box.min().array() -= kMargin_m;
  box.max().array() += kMargin_m;
  Cloud inside;
  std::copy_if(cloud.begin(), cloud.end(), std::back_inserter(inside),
               [&](const Eigen::Vector3d& point) { return box.contains(point); });
  return inside;
}

Eigen::Vector3d mean_of(const Cloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : cloud) sum += point;
  return sum / static_cast<double>(cloud.size());
}

void shift(Cloud& cloud, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& point : cloud) point += by;
}

Points::Ptr points_of(const Cloud& cloud) {
  auto points = pcl::make_shared<Points>();
  points->reserve(cloud.size());
  for (const Eigen::Vector3d& point : cloud) {
    const Eigen::Vector3f p = point.cast<float>();
    points->push_back({p.x(), p.y(), p.z()});
  }
  return points;
}

// Few enough for a registration in seconds.
Points::Ptr thinned(const Cloud& cloud, std::size_t most) {
  Points::Ptr points = points_of(cloud);
  for (double edge_m = kGridEdge_m; points->size() > most; edge_m *= kGridGrowth) {
    pcl::VoxelGrid<pcl::PointXYZ> grid;
    const auto edge = static_cast<float>(edge_m);
    grid.setLeafSize(edge, edge, edge);
    grid.setInputCloud(points);
    auto fewer = pcl::make_shared<Points>();
    grid.filter(*fewer);
    points = fewer;
  }
  return points;
}

Cloud sample_of(const Cloud& cloud) {
  const std::size_t step = cloud.size() / kSampleMax + 1;
  Cloud sample;
  for (std::size_t i = 0; i < cloud.size(); i += step) sample.push_back(cloud[i]);
  return sample;
}

Eigen::Isometry3d turned(double yaw_rad) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
}

double yaw_of(const Eigen::Isometry3d& motion) {
  return std::atan2(motion.linear()(1, 0), motion.linear()(0, 0));
}

// Without the tilt that a registration found: gravity is known better.
Eigen::Isometry3d upright(const Eigen::Matrix4f& found) {
  Eigen::Isometry3d motion(found.cast<double>());
  motion.linear() = turned(yaw_of(motion)).linear();
  return motion;
}

std::optional<Eigen::Isometry3d> align(pcl::Registration<pcl::PointXYZ, pcl::PointXYZ>& method,
                                       const Eigen::Isometry3d& guess) {
  Points ignored;
  method.align(ignored, guess.matrix().cast<float>());
  const Eigen::Matrix4f found = method.getFinalTransformation();
  if (!found.allFinite()) return std::nullopt;
  return upright(found);
}

// A motion of the layer and how well it then fits.
struct Candidate {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  RegistrationScore score;
};

class Search {
 public:
  Search(const Cloud& moving, const Cloud& fixed, double tolerance_m)
      : moving_(moving),
        sample_(sample_of(moving)),
        moving_points_(thinned(moving, kPointsMax)),
        fixed_points_(thinned(fixed, kPointsMax)),
        scorer_(fixed, tolerance_m) {}

  void run() {
    consider(Eigen::Isometry3d::Identity());
    pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ> ndt;
    ndt.setResolution(kNdtCell_m);
    ndt.setStepSize(kNdtStep_m);
    ndt.setTransformationEpsilon(0.01);
    ndt.setMaximumIterations(kNdtTurns);
    ndt.setInputTarget(fixed_points_);
    ndt.setInputSource(thinned(moving_, kCoarsePointsMax));
    for (const double heading_deg : kHeadings_deg) {
      consider(align(ndt, turned(heading_deg * std::numbers::pi / 180.0)));
    }
    for (const double reach_m : kGicpReach_m) {
      pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> gicp;
      gicp.setMaxCorrespondenceDistance(reach_m);
      gicp.setMaximumIterations(kGicpTurns);
      gicp.setInputTarget(fixed_points_);
      gicp.setInputSource(moving_points_);
      consider(align(gicp, best_.motion));
    }
  }

  const Eigen::Isometry3d& best() const { return best_.motion; }
  // Of all points.
  RegistrationScore score(const Eigen::Isometry3d& motion) const {
    return scorer_.score(moving_, motion);
  }

 private:
  void consider(const std::optional<Eigen::Isometry3d>& motion) {
    if (!motion) return;
    const RegistrationScore score = scorer_.score(sample_, *motion);
    if (score.fitting > best_.score.fitting) best_ = {*motion, score};
  }

  const Cloud& moving_;
  Cloud sample_;
  Points::Ptr moving_points_;
  Points::Ptr fixed_points_;
  RegistrationScorer scorer_;
  Candidate best_;
};

}  // namespace

tl::expected<RegistrationResult, std::string> register_layers(const Replica& layer,
                                                              const Replica& against) {
  const auto T_fleet_origin = layer.pose().origin().pose.checked();
  if (!T_fleet_origin) return tl::unexpected(std::string("the layer has no pose"));
  const Cloud all = obstacles_fleet(layer);
  Cloud fixed = obstacles_fleet(against);
  Cloud moving = cropped(all, fixed);
  fixed = cropped(fixed, all);
  if (moving.size() < kPointsMin || fixed.size() < kPointsMin) {
    return tl::unexpected(
        std::string("the layers lie too far apart, or know too little, to be compared"));
  }
  // About the middle of what may overlap: a turn then shifts nothing by a long lever.
  const Eigen::Vector3d middle = mean_of(moving);
  shift(moving, -middle);
  shift(fixed, -middle);
  Search search(moving, fixed, kToleranceVoxels * against.resolution().metres());
  search.run();
  const Eigen::Isometry3d motion_fleet =
      Eigen::Translation3d(middle) * search.best() * Eigen::Translation3d(-middle);
  const Eigen::Isometry3d T_fleet_layer = motion_fleet * layer.pose().T_fleet_layer();
  RegistrationResult result;
  result.shift_m = T_fleet_layer.translation() - T_fleet_origin->translation();
  result.yaw_rad =
      yaw_of(Eigen::Isometry3d(T_fleet_layer.linear() * T_fleet_origin->linear().transpose()));
  const RegistrationScore score = search.score(search.best());
  result.voxels = score.near;
  result.fit_before = search.score(Eigen::Isometry3d::Identity()).fit();
  result.fit = score.fit();
  result.rms_m = score.rms_m;
  return result;
}

}  // namespace warren
