// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "core/voxel/point.hpp"

namespace warren::test {

inline const std::vector<Point3f> kSamplePoints = {
    {1.5F, -2.25F, 0.125F}, {0.0F, 0.0F, 0.0F}, {-100.5F, 3.0F, 7.75F}};

template <typename T>
void append(std::string& bytes, T value) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}

inline std::string pcd_header(const std::string& encoding, const std::string& points = "3") {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS i x y z\nSIZE 2 4 8 4\nTYPE U F F F\nCOUNT 2 1 1 1\n"
         "WIDTH " +
         points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + encoding +
         "\n";
}

inline std::string sample_pcd_ascii() {
  return pcd_header("ascii") + "1 2 1.5 -2.25 0.125\n1 2 0 0 0\n1 2 -100.5 3 7.75\n";
}

inline std::string sample_pcd_binary() {
  std::string bytes = pcd_header("binary");
  for (const Point3f& p : kSamplePoints) {
    append(bytes, std::uint32_t{7});
    append(bytes, p.x);
    append(bytes, double{p.y});
    append(bytes, p.z);
  }
  return bytes;
}

// LZF with literal runs only (a run of n bytes begins with n - 1, at most 31).
inline std::string sample_pcd_compressed() {
  std::string raw;
  for (std::size_t i = 0; i < kSamplePoints.size(); ++i) append(raw, std::uint32_t{7});
  for (const Point3f& p : kSamplePoints) append(raw, p.x);
  for (const Point3f& p : kSamplePoints) append(raw, double{p.y});
  for (const Point3f& p : kSamplePoints) append(raw, p.z);
  std::string packed;
  for (std::size_t at = 0; at < raw.size(); at += 32) {
    const std::string run = raw.substr(at, 32);
    packed += static_cast<char>(run.size() - 1);
    packed += run;
  }
  std::string bytes = pcd_header("binary_compressed");
  append(bytes, static_cast<std::uint32_t>(packed.size()));
  append(bytes, static_cast<std::uint32_t>(raw.size()));
  return bytes + packed;
}

inline std::string ply_header(const std::string& format, const std::string& end = "\n") {
  return "ply" + end + "format " + format + " 1.0" + end + "comment by hand" + end +
         "element vertex 3" + end + "property uchar r" + end + "property float x" + end +
         "property double y" + end + "property float32 z" + end + "element face 1" + end +
         "property list uchar int vertex_indices" + end + "end_header" + end;
}

inline std::string sample_ply_ascii() {
  return ply_header("ascii") + "1 1.5 -2.25 0.125\n1 0 0 0\n1 -100.5 3 7.75\n3 0 1 2\n";
}

inline std::string sample_ply_binary(const std::string& line_end = "\n") {
  std::string bytes = ply_header("binary_little_endian", line_end);
  for (const Point3f& p : kSamplePoints) {
    append(bytes, std::uint8_t{9});
    append(bytes, p.x);
    append(bytes, double{p.y});
    append(bytes, p.z);
  }
  return bytes;
}

inline std::string sample_kitti() {
  std::string bytes;
  for (const Point3f& p : kSamplePoints) {
    for (const float value : {p.x, p.y, p.z, 0.5F}) append(bytes, value);
  }
  return bytes;
}

inline std::string sample_text() { return "1.5 -2.25 0.125\n0 0 0\n-100.5 3 7.75\n"; }

}  // namespace warren::test
