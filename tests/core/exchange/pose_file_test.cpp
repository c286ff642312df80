// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/pose_file.hpp"

#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "tests/core/exchange/temporary_folder.hpp"
#include "tests/support/recorded_data.hpp"

using namespace warren;
using namespace warren::test;

namespace {

// A quarter turn about z, then 1 2 3 m.
constexpr std::string_view kKitti = "0 -1 0 1 1 0 0 2 0 0 1 3\n";
constexpr std::string_view kTum = "17.5 1 2 3 0 0 0.70710678 0.70710678\n";
constexpr std::string_view kMatrix4 = "0,-1,0,1,\n1,0,0,2,\n0,0,1,3,\n0,0,0,1630577758.569490,\n";

std::string error_of(std::string_view text, PoseFormat format) {
  const auto poses = parse_poses(text, format);
  return poses ? "" : poses.error().located("f");
}

}  // namespace

TEST_CASE("the same pose is read from each format") {
  for (const auto& [text, format, time_s] :
       {std::tuple{kKitti, PoseFormat::kKitti, std::optional<double>{}},
        std::tuple{kTum, PoseFormat::kTum, std::optional<double>{17.5}},
        std::tuple{kMatrix4, PoseFormat::kMatrix4, std::optional<double>{1630577758.56949}}}) {
    const auto poses = parse_poses(text, format);
    REQUIRE(poses);
    REQUIRE(poses->size() == 1);
    const TimedPose& pose = poses->front();
    CHECK(pose.T_map_sensor.translation == Eigen::Vector3d(1, 2, 3));
    const Eigen::Vector3d turned = pose.T_map_sensor.rotation * Eigen::Vector3d::UnitX();
    CHECK((turned - Eigen::Vector3d::UnitY()).norm() < 1e-7);
    CHECK(std::abs(pose.T_map_sensor.rotation.norm() - 1.0) < 1e-12);
    CHECK(pose.time_s == time_s);
  }
}

TEST_CASE("a last element of 1 in a 4x4 matrix is no time") {
  const auto poses = parse_poses("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", PoseFormat::kMatrix4);
  REQUIRE(poses);
  CHECK_FALSE(poses->front().time_s);
}

TEST_CASE("blank lines, comments and Windows line ends do not matter") {
  const auto poses =
      parse_poses("# t x y z\r\n\r\n1 0 0 0 0 0 0 1\r\n2 0 0 0 0 0 0 1", PoseFormat::kTum);
  REQUIRE(poses);
  CHECK(poses->size() == 2);
}

TEST_CASE("a rotation with rounding errors is replaced by the nearest one") {
  const auto poses = parse_poses("0.001 -1.002 0 1 0.999 0 0.003 2 0 0 1 3", PoseFormat::kKitti);
  REQUIRE(poses);
  const Eigen::Matrix3d rotation = poses->front().T_map_sensor.rotation.toRotationMatrix();
  CHECK((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
  CHECK(rotation.determinant() == doctest::Approx(1.0));
}

TEST_CASE("what is no pose is refused with its line") {
  CHECK(error_of("1 0 0 0 0 1 0 0 0 0 1\n", PoseFormat::kKitti) ==
        "f:1: expected 12 numbers (a 3x4 matrix row by row), found 11");
  CHECK(error_of(std::string(kKitti) + std::string(kTum), PoseFormat::kTum) ==
        "f:1: expected 8 numbers (time_s x y z qx qy qz qw), found more; is it another format?");
  CHECK(error_of("1 2 3 4 0 0 zero 1", PoseFormat::kTum) ==
        "f:1: expected a finite number, found 'zero'");
  CHECK(error_of("1 nan 3 4 0 0 0 1", PoseFormat::kTum) ==
        "f:1: expected a finite number, found 'nan'");
  CHECK(error_of("1 2 3 4 0 0 0 0", PoseFormat::kTum) == "f:1: the quaternion's norm is not 1");
  CHECK(error_of("2 0 0 1 0 2 0 2 0 0 2 3", PoseFormat::kKitti) ==
        "f:1: its 3x3 part is no rotation");
  CHECK(error_of("1 0 0 1 0 1 0 2 0 0 -1 3", PoseFormat::kKitti) ==
        "f:1: its 3x3 part is no rotation");
  CHECK(error_of("1e300 0 0 1 0 1e300 0 2 0 0 1e300 3", PoseFormat::kKitti) ==
        "f:1: its 3x3 part is no rotation");
  CHECK(error_of("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 1 0 1\n", PoseFormat::kMatrix4) ==
        "f:4: the matrix's last row does not begin with 0 0 0");
  CHECK(error_of("1 0 0 0\n0 1 0 0\n", PoseFormat::kMatrix4) ==
        "f:2: the last matrix is cut short");
}

TEST_CASE("pose text cut short or damaged anywhere breaks nothing") {
  std::mt19937 random(1);
  for (const auto& [text, format] :
       {std::pair{kKitti, PoseFormat::kKitti}, std::pair{kTum, PoseFormat::kTum},
        std::pair{kMatrix4, PoseFormat::kMatrix4}}) {
    for (std::size_t at = 0; at < text.size(); ++at) {
      const auto cut = parse_poses(text.substr(0, at), format);
      if (cut) CHECK(cut->size() <= 1);
      std::string damaged(text);
      damaged[at] = static_cast<char>(random());
      const auto poses = parse_poses(damaged, format);
      if (!poses) continue;
      for (const TimedPose& pose : *poses) CHECK(pose.T_map_sensor.checked().has_value());
    }
  }
}

TEST_CASE("names of pose formats are those of the command line") {
  CHECK(pose_format_of("kitti") == PoseFormat::kKitti);
  CHECK(pose_format_of("tum") == PoseFormat::kTum);
  CHECK(pose_format_of("matrix4") == PoseFormat::kMatrix4);
  CHECK_FALSE(pose_format_of("KITTI"));
}

TEST_CASE("a pose file's errors name it") {
  const TemporaryFolder folder;
  const auto file = folder.write("poses.txt", "1 2 3");
  CHECK(read_poses(file, PoseFormat::kKitti).error() ==
        file.string() + ":1: expected 12 numbers (a 3x4 matrix row by row), found 3");
  CHECK(read_poses(folder / "none", PoseFormat::kKitti).error() ==
        (folder / "none").string() + ": no such file");
}

TEST_CASE("clouds and poses pair by line when counts match, else by the number in the name") {
  std::vector<TimedPose> poses(5);
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].time_s = static_cast<double>(i);
  const auto times = [&](const std::vector<std::filesystem::path>& files) {
    std::vector<double> paired;
    const auto pairs = pair_poses(files, poses);
    for (const TimedPose& pose : pairs.value()) paired.push_back(*pose.time_s);
    return paired;
  };
  CHECK(times({"a9", "b9", "c9", "d9", "e9"}) == std::vector<double>{0, 1, 2, 3, 4});
  CHECK(times({"full0.pcd", "full2.pcd", "full4.pcd"}) == std::vector<double>{0, 2, 4});
  CHECK(times({}).empty());

  const std::vector<std::filesystem::path> beyond = {"x/full5.pcd"};
  CHECK(pair_poses(beyond, poses).error() ==
        "1 clouds but 5 poses, so a cloud's pose is the one with the number in its name; but for "
        "full5.pcd they end at 4 (counted from 0)");
  const std::vector<std::filesystem::path> nameless = {"scan.pcd"};
  CHECK(pair_poses(nameless, poses).error() ==
        "1 clouds but 5 poses, so a cloud's pose is the one with the number in its name; scan.pcd "
        "has none");
  CHECK(pair_poses(nameless, {}).error().find("scan.pcd has none") != std::string::npos);
}

TEST_CASE("the recorded hall walk has a pose with a time for each of its frames") {
  const UnpackedData data("scans/balm_realworld/balm_every2nd_frame.tar.xz");
  if (!data.is_there()) return;
  const auto poses = read_poses(data.folder() / "alidarPose.csv", PoseFormat::kMatrix4);
  REQUIRE_MESSAGE(poses, poses.error());
  CHECK(poses->size() == 177);
  CHECK(poses->front().time_s == 1630577758.569490);
}
