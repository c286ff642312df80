// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/cloud_reader.hpp"

#include <doctest/doctest.h>

#include "tests/core/exchange/cloud_samples.hpp"
#include "tests/core/exchange/temporary_folder.hpp"
#include "tests/support/recorded_data.hpp"

using namespace warren;
using namespace warren::test;

namespace {

std::vector<std::string> names_of(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  for (const auto& file : files) names.push_back(file.filename().string());
  return names;
}

}  // namespace

TEST_CASE("the ending of a file, in any case, says its format") {
  const TemporaryFolder folder;
  for (const auto& sample : {std::pair<std::string, std::string>{"a.PCD", sample_pcd_binary()},
                             {"a.ply", sample_ply_binary()},
                             {"a.bin", sample_kitti()},
                             {"a.txt", sample_text()},
                             {"a.xyz", sample_text()},
                             {"a.dat", sample_text()},
                             {"a.Csv", sample_text()}}) {
    const auto cloud = read_cloud(folder.write(sample.first, sample.second));
    REQUIRE_MESSAGE(cloud, cloud.error());
    CHECK_MESSAGE(cloud->points == kSamplePoints, sample.first);
  }
}

TEST_CASE("an error names the file and its line") {
  const TemporaryFolder folder;
  const auto file = folder.write("bad.xyz", "1 2 3\n4 five 6\n");
  CHECK(read_cloud(file).error() == file.string() + ":2: expected a number, found 'five'");
  CHECK(read_cloud(folder / "none.pcd").error() ==
        (folder / "none.pcd").string() + ": no such file");
  CHECK(read_cloud(folder / "a.las").error() ==
        (folder / "a.las").string() +
            ": no cloud by its ending; known are .pcd .ply .bin .txt .xyz .dat .csv");
}

TEST_CASE("a folder or a pipe is no cloud") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a.pcd");
  CHECK(read_cloud(folder / "a.pcd").error() ==
        (folder / "a.pcd").string() + ": not a regular file");
}

TEST_CASE("clouds of a folder come in natural order, without what else lies there") {
  const TemporaryFolder folder;
  for (const char* name : {"full10.pcd", "full2.pcd", "full1.pcd", "poses.csv", "README.md"}) {
    folder.write(name, "");
  }
  std::filesystem::create_directory(folder / "full3.pcd");
  const auto clouds = list_clouds(folder.path());
  REQUIRE(clouds);
  CHECK(names_of(*clouds) == std::vector<std::string>{"full1.pcd", "full2.pcd", "full10.pcd"});
}

TEST_CASE("text clouds are listed where there are no others") {
  const TemporaryFolder folder;
  for (const char* name : {"scan2.txt", "scan10.txt"}) folder.write(name, "");
  CHECK(names_of(list_clouds(folder.path()).value()) ==
        std::vector<std::string>{"scan2.txt", "scan10.txt"});
}

TEST_CASE("one file is a list of one, and nothing is an error") {
  const TemporaryFolder folder;
  const auto file = folder.write("a.pcd", "");
  CHECK(list_clouds(file).value() == std::vector<std::filesystem::path>{file});
  CHECK(list_clouds(folder / "none").error() ==
        (folder / "none").string() + ": no such file or directory");
  const TemporaryFolder empty;
  CHECK(list_clouds(empty.path()).error() ==
        empty.path().string() + ": holds no cloud; known are .pcd .ply .bin .txt .xyz .dat .csv");
}

TEST_CASE("columns named x, y and z are found in a recorded CSV") {
  const auto file = recorded_file("scans/libpointmatcher/car_cloud400.csv");
  if (!file) return;
  const auto cloud = read_cloud(*file);
  REQUIRE_MESSAGE(cloud, cloud.error());
  CHECK(cloud->points.size() > 10'000);
  CHECK(cloud->points.front() == Point3f{-3.5376F, 0.639553F, -1.37678F});
}
