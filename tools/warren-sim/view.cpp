// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-sim/view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace warren::world {
namespace {

constexpr Colour kBackground{24, 26, 30};
constexpr float kMargin = 1.06F;
constexpr int kMaxCuts = 64;  // surfaces that one ray may pass because they are cut away

Colour colour_of(Surface surface) {
  switch (surface) {
    case Surface::kRock:
      return {158, 134, 112};
    case Surface::kFloor:
      return {190, 172, 142};
    case Surface::kWall:
      return {170, 170, 176};
    case Surface::kCeiling:
      return {128, 128, 136};
    case Surface::kStairs:
      return {232, 156, 62};
    case Surface::kRamp:
      return {214, 196, 92};
    case Surface::kRail:
      return {112, 92, 84};
    case Surface::kBoulder:
      return {124, 110, 100};
    case Surface::kRubble:
      return {142, 120, 104};
    case Surface::kStepfield:
      return {206, 168, 120};
    case Surface::kCable:
      return {226, 74, 62};
    case Surface::kFence:
      return {92, 178, 208};
    case Surface::kImported:
      return {176, 170, 160};
  }
  return {255, 0, 255};
}

struct Pixel {
  float depth_m = std::numeric_limits<float>::infinity();
  Colour colour = kBackground;
};

// The first surface that is not left out, its normal towards the viewer.
std::optional<RayReturn> first_shown(const Caster& caster, Ray ray, const Style& style) {
  constexpr float kStepM = 1e-3F;
  float gone_m = 0.0F;
  for (int i = 0; i < kMaxCuts; ++i) {
    auto hit = caster.cast(ray);
    if (!hit) return std::nullopt;
    const Eigen::Vector3f position = ray.origin + hit->range_m * ray.direction;
    const bool from_behind = hit->normal.dot(ray.direction) > 0.0F;
    const bool shown = !from_behind || style.backs == Backs::kSolid;
    if (shown && !style.is_cut(position)) {
      if (from_behind) hit->normal = -hit->normal;
      hit->range_m += gone_m;
      return hit;
    }
    gone_m += hit->range_m + kStepM;
    ray.max_range_m -= hit->range_m + kStepM;
    if (ray.max_range_m <= 0.0F) return std::nullopt;
    ray.origin = position + kStepM * ray.direction;
  }
  return std::nullopt;
}

Pixel trace(const Caster& caster, const Ray& ray, const Style& style) {
  const auto hit = first_shown(caster, ray, style);
  if (!hit) return {};
  // Light from above, a little from the side, and a lamp on the viewer's head.
  const Eigen::Vector3f above = Eigen::Vector3f(0.2F, 0.3F, 1.0F).normalized();
  const float lit = 0.45F * std::max(0.0F, hit->normal.dot(above)) -
                    0.4F * hit->normal.dot(ray.direction) + 0.25F;
  return {hit->range_m, shaded(colour_of(caster.mesh().surfaces[hit->triangle]), lit)};
}

// How much darker a pixel is because neighbours are nearer.
float edge_shade(const std::vector<Pixel>& pixels, int width, int height, int x, int y) {
  const auto depth = [&](int right, int down) {
    const auto column = static_cast<std::size_t>(std::clamp(right, 0, width - 1));
    const auto row = static_cast<std::size_t>(std::clamp(down, 0, height - 1));
    return pixels[row * static_cast<std::size_t>(width) + column].depth_m;
  };
  const float here = depth(x, y);
  if (!std::isfinite(here)) return 1.0F;
  float in_front = 0.0F;
  for (const auto& [right, down] : {std::pair{-2, 0}, {2, 0}, {0, -2}, {0, 2}}) {
    in_front += std::clamp((here - depth(x + right, y + down)) / (0.02F * here + 0.5F), 0.0F, 1.0F);
  }
  return 1.0F - 0.18F * in_front;
}

Colour mean(const std::array<Colour, 4>& colours) {
  std::array<int, 3> sums{};
  for (const Colour& colour : colours) {
    sums[0] += colour.red;
    sums[1] += colour.green;
    sums[2] += colour.blue;
  }
  return {static_cast<std::uint8_t>(sums[0] / 4), static_cast<std::uint8_t>(sums[1] / 4),
          static_cast<std::uint8_t>(sums[2] / 4)};
}

}  // namespace

View parallel_view(const Eigen::AlignedBox3f& box, double azimuth_rad, double elevation_rad) {
  const auto azimuth = static_cast<float>(azimuth_rad);
  const auto elevation = static_cast<float>(elevation_rad);
  const Eigen::Vector3f forward(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), -std::sin(elevation));
  const Eigen::Vector3f right(std::sin(azimuth), -std::cos(azimuth), 0.0F);
  const Eigen::Vector3f up = right.cross(forward);
  float half_right = 0.0F;
  float half_up = 0.0F;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f offset =
        box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner)) - box.center();
    half_right = std::max(half_right, std::abs(right.dot(offset)));
    half_up = std::max(half_up, std::abs(up.dot(offset)));
  }
  View view;
  const auto half_width = 0.5F * static_cast<float>(view.width);
  const auto half_height = 0.5F * static_cast<float>(view.height);
  const float metres_per_pixel =
      kMargin * std::max({half_right / half_width, half_up / half_height, 1e-4F});
  const float reach = box.diagonal().norm() + 2.0F;
  view.ray = [=, centre = Eigen::Vector3f(box.center())](double x, double y) {
    const float across = (static_cast<float>(x) - half_width) * metres_per_pixel;
    const float along = (half_height - static_cast<float>(y)) * metres_per_pixel;
    return Ray{centre + across * right + along * up - 0.5F * reach * forward, forward, reach};
  };
  return view;
}

View eye_view(const Eigen::Vector3f& eye, double yaw_rad, double pitch_rad, double field_rad) {
  const auto yaw = static_cast<float>(yaw_rad);
  const auto pitch = static_cast<float>(pitch_rad);
  const Eigen::Vector3f forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                                std::sin(pitch));
  const Eigen::Vector3f right(std::sin(yaw), -std::cos(yaw), 0.0F);
  const Eigen::Vector3f up = right.cross(forward);
  View view;
  const auto half_width = 0.5F * static_cast<float>(view.width);
  const auto half_height = 0.5F * static_cast<float>(view.height);
  const float per_pixel = std::tan(0.5F * static_cast<float>(field_rad)) / half_width;
  view.ray = [=](double x, double y) {
    const float across = (static_cast<float>(x) - half_width) * per_pixel;
    const float along = (half_height - static_cast<float>(y)) * per_pixel;
    return Ray{eye, (forward + across * right + along * up).normalized(), 500.0F};
  };
  return view;
}

Image draw(const Caster& caster, const View& view, const Style& style) {
  const int width = 2 * view.width;
  const int height = 2 * view.height;
  std::vector<Pixel> pixels;
  pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      pixels.push_back(trace(caster, view.ray(0.5 * x + 0.25, 0.5 * y + 0.25), style));
    }
  }
  Image image(view.width, view.height, kBackground);
  const auto shown = [&](int x, int y) {
    const auto index =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    return shaded(pixels[index].colour, edge_shade(pixels, width, height, x, y));
  };
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      image.at(x, y) = mean({shown(2 * x, 2 * y), shown(2 * x + 1, 2 * y), shown(2 * x, 2 * y + 1),
                             shown(2 * x + 1, 2 * y + 1)});
    }
  }
  return image;
}

}  // namespace warren::world
