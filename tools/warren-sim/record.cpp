// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-sim/record.hpp"

#include <ctime>
#include <fstream>
#include <span>

#include <fmt/format.h>

#include "core/exchange/float_rows.hpp"

namespace warren::world {
namespace {

std::string kitti_line(const Eigen::Isometry3d& pose) {
  std::string line;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      line += fmt::format("{}{:.9g}", line.empty() ? "" : " ", pose.matrix()(row, column));
    }
  }
  return line + "\n";
}

static_assert(sizeof(Point3f) == 3 * sizeof(float));
std::span<const float> values_of(const std::vector<Point3f>& points) {
  return {reinterpret_cast<const float*>(points.data()), 3 * points.size()};
}

tl::unexpected<std::string> cannot_write(const std::filesystem::path& path) {
  return tl::unexpected("cannot write " + path.string());
}

// The files of one robot.
class RobotFolder {
 public:
  explicit RobotFolder(const std::filesystem::path& folder) : folder_(folder) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder / "clouds");
    poses_.open(folder / "poses.txt");
    true_poses_.open(folder / "true_poses.txt");
  }

  tl::expected<void, std::string> add(const Frame& frame) {
    const auto cloud = folder_ / "clouds" / fmt::format("{:06}.pcd", frames_++);
    const auto written = write_rows_pcd({{"x", "y", "z"}, values_of(frame.points_sensor)}, cloud);
    if (!written) return tl::unexpected(cloud.string() + ": " + written.error());
    poses_ << kitti_line(frame.T_map_base * frame.T_base_sensor);
    true_poses_ << kitti_line(frame.T_world_base * frame.T_base_sensor);
    if (!poses_ || !true_poses_) return cannot_write(folder_ / "poses.txt");
    return {};
  }

  tl::expected<void, std::string> finish() {
    poses_.close();
    true_poses_.close();
    if (!poses_ || !true_poses_) return cannot_write(folder_ / "poses.txt");
    return {};
  }

 private:
  std::filesystem::path folder_;
  std::ofstream poses_;
  std::ofstream true_poses_;
  std::size_t frames_ = 0;
};

std::optional<Frame> next_timed(FrameStream& frames, double& cpu_s) {
  const std::clock_t before = std::clock();
  auto frame = frames.next();
  cpu_s += static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  return frame;
}

}  // namespace

tl::expected<RecordSummary, std::string> record(const Simulation& simulation,
                                                const std::filesystem::path& directory,
                                                const RecordProgress& progress) {
  std::size_t all = 0;
  for (std::size_t robot = 0; robot < simulation.spec().robots.size(); ++robot) {
    all += FrameStream(simulation, robot).count();
  }
  RecordSummary summary;
  for (std::size_t robot = 0; robot < simulation.spec().robots.size(); ++robot) {
    RobotFolder folder(directory / simulation.spec().robots[robot].name);
    FrameStream frames(simulation, robot);
    while (const auto frame = next_timed(frames, summary.cast_cpu_s)) {
      if (const auto added = folder.add(*frame); !added) return tl::unexpected(added.error());
      progress(++summary.sweeps, all);
    }
    if (const auto done = folder.finish(); !done) return tl::unexpected(done.error());
  }
  return summary;
}

}  // namespace warren::world
