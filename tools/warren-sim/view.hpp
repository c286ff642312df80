// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <Eigen/Geometry>

#include "core/exchange/image.hpp"
#include "tools/world/caster.hpp"

namespace warren::world {

// Where each pixel's ray begins and goes.
struct View {
  int width = 1600;
  int height = 900;
  std::function<Ray(double right, double down)> ray;  // by pixel, (0, 0) the upper left corner
};

// A parallel view of all of a box from a direction given by azimuth and elevation.
View parallel_view(const Eigen::AlignedBox3f& box, double azimuth_rad, double elevation_rad);
// What an eye sees that looks along a yaw, `field_rad` wide.
View eye_view(const Eigen::Vector3f& eye, double yaw_rad, double pitch_rad, double field_rad);

// True for what a picture leaves out.
using IsCut = std::function<bool(const Eigen::Vector3f& position)>;

enum class Backs {
  kSolid,        // the rock around the passages hides them
  kTransparent,  // surfaces seen from within the rock are looked through
};

// Casts four rays per pixel; colour by surface kind and height, light from above and from the
// viewer, and darker where neighbours stand in front ("eye-dome lighting").
struct Style {
  IsCut is_cut = [](const Eigen::Vector3f&) { return false; };
  Backs backs = Backs::kTransparent;
};
Image draw(const Caster& caster, const View& view, const Style& style);

}  // namespace warren::world
