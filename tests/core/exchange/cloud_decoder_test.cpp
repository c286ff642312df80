// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "core/exchange/cloud_decoders.hpp"
#include "tests/core/exchange/cloud_samples.hpp"

using namespace warren;
using namespace warren::test;

namespace {

using Decoder = Decoded<Cloud> (*)(std::string_view);

struct Sample {
  const char* name;
  Decoder decode;
  std::string bytes;
};

std::vector<Sample> samples() {
  return {{"PCD ascii", decode_pcd, sample_pcd_ascii()},
          {"PCD binary", decode_pcd, sample_pcd_binary()},
          {"PCD compressed", decode_pcd, sample_pcd_compressed()},
          {"PLY ascii", decode_ply, sample_ply_ascii()},
          {"PLY binary", decode_ply, sample_ply_binary()},
          {"PLY binary, CRLF", decode_ply, sample_ply_binary("\r\n")},
          {"KITTI", decode_kitti_bin, sample_kitti()},
          {"text", decode_text_cloud, sample_text()}};
}

std::string error_of(const Decoded<Cloud>& cloud) {
  return cloud ? "" : cloud.error().located("f");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("every format gives the sample's points") {
  for (const Sample& sample : samples()) {
    CAPTURE(sample.name);
    const auto cloud = sample.decode(sample.bytes);
    REQUIRE_MESSAGE(cloud, error_of(cloud));
    CHECK(cloud->points == kSamplePoints);
  }
}

TEST_CASE("a file cut short at any length is an error, not a smaller cloud") {
  for (const Sample& sample : samples()) {
    CAPTURE(sample.name);
    const bool has_header = sample.decode != decode_kitti_bin && sample.decode != decode_text_cloud;
    for (std::size_t length = 0; length < sample.bytes.size(); ++length) {
      const auto cloud = sample.decode(std::string_view(sample.bytes).substr(0, length));
      if (has_header && cloud) CHECK(cloud->points.size() == kSamplePoints.size());
    }
  }
}

TEST_CASE("a damaged byte breaks nothing") {
  std::mt19937 random(1);
  for (const Sample& sample : samples()) {
    for (std::size_t at = 0; at < sample.bytes.size(); ++at) {
      std::string bytes = sample.bytes;
      bytes[at] = static_cast<char>(random());
      const auto cloud = sample.decode(bytes);
      if (cloud) CHECK(cloud->points.size() <= sample.bytes.size());
    }
  }
}

TEST_CASE("NaN marks no return and stays in its place") {
  const auto ascii = decode_pcd(replaced(sample_pcd_ascii(), "1 2 0 0 0", "1 2 nan nan NaN"));
  REQUIRE(ascii);
  CHECK(std::isnan(ascii->points[1].x));
  const auto text = decode_text_cloud("1 2 3\nnan nan nan\n4 5 6\n");
  REQUIRE(text);
  CHECK(text->points.size() == 3);
  CHECK(std::isnan(text->points[1].z));
}

TEST_CASE("a double beyond float32 becomes infinity") {
  const auto cloud = decode_text_cloud("1e300 -1e300 1e-300\n");
  REQUIRE(cloud);
  CHECK(cloud->points[0].x == std::numeric_limits<float>::infinity());
  CHECK(cloud->points[0].y == -std::numeric_limits<float>::infinity());
  CHECK(cloud->points[0].z == 0.0F);
}

TEST_CASE("PCD headers that lie are refused with a reason") {
  const std::string ascii = sample_pcd_ascii();
  const auto error = [&](const std::string& from, const std::string& to) {
    return error_of(decode_pcd(replaced(ascii, from, to)));
  };
  CHECK(error("POINTS 3", "POINTS 4") == "f: POINTS is not WIDTH times HEIGHT");
  CHECK(error("WIDTH 3", "WIDTH 99999999999999999999999") == "f:7: 'WIDTH' needs a count");
  CHECK(error("WIDTH 3", "WIDTH 4000000000") == "f: more than 50000000 points");
  CHECK(error("SIZE 2", "SIZE 0") == "f: SIZE of field 'i' must be 1, 2, 4 or 8");
  CHECK(error("COUNT 2", "COUNT -1") == "f: COUNT of field 'i' must be 1..65536");
  CHECK(error("COUNT 2", "COUNT 65536") == "f: a point has more than 65536 bytes");
  CHECK(error("TYPE U", "TYPE U U") == "f: FIELDS, SIZE, TYPE and COUNT differ in length");
  CHECK(error("i x y z", "i x y w") == "f: has no field 'z'");
  CHECK(error("F F F", "F I F") == "f: field 'y' must be one float32 or float64");
  CHECK(error("ascii", "zip") == "f: DATA must be ascii, binary or binary_compressed, not 'zip'");
  CHECK(error("-2.25", "two") == "f:12: expected a number, found 'two'");
  CHECK(error_of(decode_pcd("")) == "f: no PCD file: its header has no DATA line");
  CHECK(error_of(decode_pcd("\x89PNG\r\n")) == "f:1: no PCD header entry: '?PNG'");
}

TEST_CASE("compressed data cannot ask for memory that it does not fill") {
  std::string bytes = pcd_header("binary_compressed", "40000000");
  append(bytes, std::uint32_t{4});
  append(bytes, std::uint32_t{800'000'000});
  CHECK(error_of(decode_pcd(bytes + "abcd")) ==
        "f: the compressed data cannot be as long as it claims");
  bytes = sample_pcd_compressed();
  bytes[bytes.size() - 1 - 8] = '\x7f';
  CHECK(decode_pcd(bytes).has_value());  // a literal: other numbers, still a cloud
  bytes.back() = 0;
  bytes.resize(bytes.size() - 1);
  CHECK_FALSE(decode_pcd(bytes).has_value());
}

TEST_CASE("an old PCD header without COUNT and POINTS is understood") {
  const auto cloud = decode_pcd(
      "COLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nDATA ascii\n1 2 3\n4 5 6\n");
  REQUIRE_MESSAGE(cloud, error_of(cloud));
  CHECK(cloud->points == std::vector<Point3f>{{1, 2, 3}, {4, 5, 6}});
}

TEST_CASE("PLY headers that cannot be served are refused with a reason") {
  const std::string ascii = sample_ply_ascii();
  const auto error = [&](const std::string& from, const std::string& to) {
    return error_of(decode_ply(replaced(ascii, from, to)));
  };
  CHECK(error("ascii", "binary_big_endian") ==
        "f:2: format must be ascii or binary_little_endian, not 'binary_big_endian'");
  CHECK(error("vertex 3", "vertex 4000000000") == "f:4: needs a vertex count of at most 50000000");
  CHECK(error("property uchar r", "property list uchar int r") ==
        "f:5: a vertex property must be a scalar, not 'list'");
  CHECK(error("float x", "float q") ==
        "f: its vertices have no x, y and z of type float or double");
  CHECK(error("element vertex 3", "element face 3") ==
        "f:4: the first element must be vertex, not 'face'");
  CHECK(error("1 0 0 0\n", "1 0 0\n") == "f:13: expected 4 columns");
  CHECK(error_of(decode_ply("plywood")) == "f:1: no PLY file: it does not begin with 'ply'");
}

TEST_CASE("text clouds take spaces, tabs, commas, comments and more columns") {
  const auto cloud = decode_text_cloud(
      "# made by hand\r\n1.5,-2.25 , 0.125,99\r\n\r\n0\t0\t+0\n  -1.005e2; 3 7.75 word\n");
  REQUIRE_MESSAGE(cloud, error_of(cloud));
  CHECK(cloud->points == kSamplePoints);
}

TEST_CASE("a first line of names says which columns are x, y and z") {
  const auto named = decode_text_cloud("time,Z,x,y\n9,3,1,2\n");
  REQUIRE(named);
  CHECK(named->points == std::vector<Point3f>{{1, 2, 3}});
  const auto other_names = decode_text_cloud("east north up\n1 2 3\n");
  REQUIRE(other_names);
  CHECK(other_names->points == std::vector<Point3f>{{1, 2, 3}});
}

TEST_CASE("text that is no cloud is refused with its line") {
  CHECK(error_of(decode_text_cloud("1 2 3\n1 2\n")) == "f:2: expected x y z, found fewer columns");
  CHECK(error_of(decode_text_cloud("x y z\nx y z\n")) == "f:2: expected a number, found 'x'");
}

TEST_CASE("KITTI clouds are whole records") {
  CHECK(decode_kitti_bin("").value().points.empty());
  CHECK(error_of(decode_kitti_bin("12345")) ==
        "f: 5 bytes are no whole number of 16-byte records x y z intensity");
}
