// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Geometry>

#include "core/exchange/image.hpp"

namespace warren {

// Looks along a direction given by azimuth (from x to y) and elevation above the horizon; parallel
// projection.
class Camera {
 public:
  Camera(double azimuth_rad, double elevation_rad);

  // Scales and moves so that the box (voxels) fills the area (pixels) but for a margin.
  void fit(const Eigen::AlignedBox3d& box, int width, int height);

  // Voxels to pixels right and down, and depth in voxels.
  Eigen::Vector3d project(const Eigen::Vector3d& position) const;
  double pixels_per_voxel() const { return pixels_per_voxel_; }
  const Eigen::Vector3d& right() const { return right_; }
  const Eigen::Vector3d& up() const { return up_; }
  const Eigen::Vector3d& forward() const { return forward_; }

 private:
  Eigen::Vector3d right_;
  Eigen::Vector3d up_;
  Eigen::Vector3d forward_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double pixels_per_voxel_ = 1.0;
  double middle_x_ = 0.0;
  double middle_y_ = 0.0;
};

// Draws cubes as squares into a depth buffer at twice the size, then darkens each pixel by how far
// its neighbours stand in front of it ("eye-dome lighting"), which shows edges and hollows.
class SplatView {
 public:
  SplatView(const Camera& camera, const Eigen::AlignedBox3d& box, int width, int height);

  // A cube around a position; `edge` in voxels, normal zero if unknown.
  void add_cube(const Eigen::Vector3d& position, double edge, const Eigen::Vector3f& normal,
                const Colour& colour);
  // A patch of ground that casts no edges and hides nothing.
  void add_ground(const Eigen::Vector3d& position, double edge, const Colour& colour);

  void draw_to(Image& image, int left, int top) const;
  double pixels_per_voxel() const { return camera_.pixels_per_voxel() / kOversampling; }

 private:
  static constexpr int kOversampling = 2;
  static constexpr float kFar = 1e30F;
  struct Pixel {
    float depth = kFar;
    Colour colour{};
    bool covered = false;
  };

  void splat(const Eigen::Vector3d& position, double edge, float depth, const Colour& colour);
  float edge_shade(int x, int y) const;
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  const Pixel& at(int x, int y) const { return pixels_[index(x, y)]; }

  Camera camera_;
  Eigen::Vector3f light_;
  int width_;  // of the buffer
  int height_;
  std::vector<Pixel> pixels_;
};

}  // namespace warren
