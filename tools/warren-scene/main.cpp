// SPDX-License-Identifier: Apache-2.0
// Makes a short simulated lidar recording of a cave: DIR/clouds/*.pcd, DIR/poses.txt (kitti).
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <span>

#include <CLI/CLI.hpp>

#include "core/voxel/point.hpp"
#include "tools/warren-scene/cave.hpp"

namespace {

struct Options {
  std::uint32_t seed = 1;
  int scans = 60;
  int rings = 64;
  int columns = 512;
  std::string out;
};

constexpr double kSensorHeightM = 0.6;
constexpr double kMaxRangeM = 40.0;
constexpr double kHalfFieldRad = 0.39;  // 64 rings over 45 degrees
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Distance to the rock along a unit direction; nothing returned beyond the range.
double march(const warren::Cave& cave, const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  constexpr double kSafe = 0.6;  // the field is no true distance where it is bumpy
  constexpr double kHitM = 0.005;
  double range_m = 0.0;
  for (int step = 0; step < 400 && range_m < kMaxRangeM; ++step) {
    const double free_m = cave.distance_m(from + range_m * along);
    if (free_m < kHitM) return range_m;
    range_m += kSafe * free_m;
  }
  return std::numeric_limits<double>::infinity();
}

std::vector<warren::Point3f> scan_from(const warren::Cave& cave, const Eigen::Vector3d& sensor,
                                       double yaw_rad, const Options& options) {
  std::vector<warren::Point3f> points;
  for (int ring = 0; ring < options.rings; ++ring) {
    const double pitch = kHalfFieldRad * (2.0 * ring / (options.rings - 1) - 1.0);
    for (int column = 0; column < options.columns; ++column) {
      const double azimuth = 2.0 * std::numbers::pi * column / options.columns;
      const Eigen::Vector3d unit(std::cos(pitch) * std::cos(azimuth),
                                 std::cos(pitch) * std::sin(azimuth), std::sin(pitch));
      const Eigen::Vector3d along(std::cos(yaw_rad) * unit.x() - std::sin(yaw_rad) * unit.y(),
                                  std::sin(yaw_rad) * unit.x() + std::cos(yaw_rad) * unit.y(),
                                  unit.z());
      const double range_m = march(cave, sensor, along);
      if (!std::isfinite(range_m)) {
        points.push_back({kNaN, kNaN, kNaN});
        continue;
      }
      const Eigen::Vector3f point = (unit * range_m).cast<float>();
      points.push_back({point.x(), point.y(), point.z()});
    }
  }
  return points;
}

bool write_pcd(const std::filesystem::path& path, const std::vector<warren::Point3f>& points) {
  std::ofstream file(path, std::ios::binary);
  file << "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\n"
       << "TYPE F F F\nCOUNT 1 1 1\nWIDTH " << points.size()
       << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << points.size() << "\nDATA binary\n";
  const auto bytes = std::as_bytes(std::span(points));
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  return file.good();
}

std::string kitti_line(const Eigen::Vector3d& position, double yaw_rad) {
  char line[256];
  std::snprintf(line, sizeof(line), "%.9f %.9f 0 %.6f %.9f %.9f 0 %.6f 0 0 1 %.6f\n",
                std::cos(yaw_rad), -std::sin(yaw_rad), position.x(), std::sin(yaw_rad),
                std::cos(yaw_rad), position.y(), position.z());
  return line;
}

bool record(const Options& options) {
  const std::filesystem::path out = options.out;
  std::filesystem::create_directories(out / "clouds");
  const warren::Cave cave(options.seed);
  std::ofstream poses(out / "poses.txt");
  for (int i = 0; i < options.scans; ++i) {
    const double along_m = cave.length_m() * i / std::max(1, options.scans - 1);
    const Eigen::Vector3d here = cave.floor_at(along_m);
    const Eigen::Vector3d ahead = cave.floor_at(along_m + 0.1);
    const double yaw_rad = std::atan2(ahead.y() - here.y(), ahead.x() - here.x());
    const Eigen::Vector3d sensor = here + Eigen::Vector3d(0.0, 0.0, kSensorHeightM);
    char name[32];
    std::snprintf(name, sizeof(name), "%06d.pcd", i);
    if (!write_pcd(out / "clouds" / name, scan_from(cave, sensor, yaw_rad, options))) return false;
    poses << kitti_line(sensor, yaw_rad);
  }
  return poses.flush().good();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes a short simulated lidar recording of a cave");
  Options options;
  app.add_option("--seed", options.seed, "of the cave")->capture_default_str();
  app.add_option("--scans", options.scans)->check(CLI::Range(1, 10000))->capture_default_str();
  app.add_option("--rings", options.rings)->check(CLI::Range(2, 256))->capture_default_str();
  app.add_option("--columns", options.columns)->check(CLI::Range(4, 4096))->capture_default_str();
  app.add_option("--out", options.out, "directory; made if missing")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    if (record(options)) return 0;
  } catch (const std::filesystem::filesystem_error& error) {
    std::fprintf(stderr, "warren-scene: %s\n", error.what());
    return 1;
  }
  std::fprintf(stderr, "warren-scene: cannot write to %s\n", options.out.c_str());
  return 1;
}
