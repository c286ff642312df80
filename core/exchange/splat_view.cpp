// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/splat_view.hpp"

#include <algorithm>
#include <cmath>

namespace warren {
namespace {

constexpr double kFilledShare = 0.94;
constexpr float kAmbient = 0.62F;
constexpr float kDiffuse = 0.55F;
constexpr float kFlatStep =
    1.8F;  // voxels: depth differences up to this are the lattice's, no edge
constexpr float kDeepest = 20.0F;  // voxels: deeper is not darker
constexpr float kEdgeStrength = 0.030F;
constexpr int kEdgeRadius = 3;  // pixels of the buffer
constexpr float kGroundDepth = 1e20F;

}  // namespace

Camera::Camera(double azimuth_rad, double elevation_rad)
    : right_(std::sin(azimuth_rad), -std::cos(azimuth_rad), 0.0),
      forward_(std::cos(elevation_rad) * std::cos(azimuth_rad),
               std::cos(elevation_rad) * std::sin(azimuth_rad), -std::sin(elevation_rad)) {
  up_ = right_.cross(forward_);
}

void Camera::fit(const Eigen::AlignedBox3d& box, int width, int height) {
  const Eigen::Vector3d half = box.sizes() / 2.0;
  const double half_right = right_.cwiseAbs().dot(half);
  const double half_up = up_.cwiseAbs().dot(half);
  centre_ = box.center();
  middle_x_ = width / 2.0;
  middle_y_ = height / 2.0;
  pixels_per_voxel_ = kFilledShare * std::min(middle_x_ / std::max(half_right, 1.0),
                                              middle_y_ / std::max(half_up, 1.0));
}

Eigen::Vector3d Camera::project(const Eigen::Vector3d& position) const {
  const Eigen::Vector3d offset = position - centre_;
  return {middle_x_ + right_.dot(offset) * pixels_per_voxel_,
          middle_y_ - up_.dot(offset) * pixels_per_voxel_, forward_.dot(offset)};
}

SplatView::SplatView(const Camera& camera, const Eigen::AlignedBox3d& box, int width, int height)
    : camera_(camera),
      light_((-0.45 * camera.right() + 0.35 * camera.up() - 0.5 * camera.forward() +
              0.6 * Eigen::Vector3d::UnitZ())
                 .normalized()
                 .cast<float>()),
      width_(width * kOversampling),
      height_(height * kOversampling),
      pixels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {
  camera_.fit(box, width_, height_);
}

void SplatView::add_cube(const Eigen::Vector3d& position, double edge,
                         const Eigen::Vector3f& normal, const Colour& colour) {
  const float facing = normal.squaredNorm() > 0.0F ? std::max(normal.dot(light_), 0.0F) : 0.6F;
  splat(position, edge, static_cast<float>(camera_.project(position).z()),
        shaded(colour, kAmbient + kDiffuse * facing));
}

void SplatView::add_ground(const Eigen::Vector3d& position, double edge, const Colour& colour) {
  splat(position, edge, kGroundDepth, colour);
}

void SplatView::splat(const Eigen::Vector3d& position, double edge, float depth,
                      const Colour& colour) {
  const Eigen::Vector3d middle = camera_.project(position);
  const double scale = camera_.pixels_per_voxel() * edge / 2.0;
  const double half_x = scale * camera_.right().cwiseAbs().maxCoeff() * 1.2;
  const double half_y = scale * std::max(camera_.up().cwiseAbs().maxCoeff(), 0.5) * 1.2;
  // Clamped before the cast: positions far outside the view must not overflow an int.
  const auto pixel = [](double value, int limit) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
  };
  const int left = pixel(std::floor(middle.x() - half_x), width_);
  const int right = pixel(std::ceil(middle.x() + half_x), width_);
  const int top = pixel(std::floor(middle.y() - half_y), height_);
  const int bottom = pixel(std::ceil(middle.y() + half_y), height_);
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      Pixel& pixel_here = pixels_[index(x, y)];
      if (depth < pixel_here.depth) pixel_here = {depth, colour, true};
    }
  }
}

float SplatView::edge_shade(int x, int y) const {
  const float depth = at(x, y).depth;
  if (depth >= kGroundDepth) return 1.0F;
  float in_front = 0.0F;
  for (int dy = -kEdgeRadius; dy <= kEdgeRadius; dy += kEdgeRadius) {
    for (int dx = -kEdgeRadius; dx <= kEdgeRadius; dx += kEdgeRadius) {
      const int nx = std::clamp(x + dx, 0, width_ - 1);
      const int ny = std::clamp(y + dy, 0, height_ - 1);
      in_front += std::clamp(depth - at(nx, ny).depth - kFlatStep, 0.0F, kDeepest);
    }
  }
  return std::exp(-kEdgeStrength * in_front);
}

void SplatView::draw_to(Image& image, int left, int top) const {
  for (int y = 0; y < height_ / kOversampling; ++y) {
    for (int x = 0; x < width_ / kOversampling; ++x) {
      Colour& target = image.at(left + x, top + y);
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int i = 0; i < kOversampling * kOversampling; ++i) {
        const int px = x * kOversampling + i % kOversampling;
        const int py = y * kOversampling + i / kOversampling;
        const Pixel& pixel = at(px, py);
        const Colour colour = pixel.covered ? shaded(pixel.colour, edge_shade(px, py)) : target;
        sum += Eigen::Vector3f(colour.red, colour.green, colour.blue);
      }
      sum /= static_cast<float>(kOversampling * kOversampling);
      target = {static_cast<std::uint8_t>(sum.x()), static_cast<std::uint8_t>(sum.y()),
                static_cast<std::uint8_t>(sum.z())};
    }
  }
}

}  // namespace warren
