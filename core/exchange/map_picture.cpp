// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/map_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/exchange/exported_map.hpp"
#include "core/exchange/image.hpp"
#include "core/exchange/map_frame.hpp"
#include "core/exchange/map_relief.hpp"
#include "core/exchange/source_legend.hpp"
#include "core/exchange/splat_view.hpp"

namespace warren {
namespace {

constexpr int kWidth = 1600;
constexpr int kHeight = 900;
constexpr Rectangle kTopPanel{20, 84, 770, 740};
constexpr Rectangle kObliquePanel{810, 84, 770, 740};
constexpr Rectangle kLegend{1180, 862, 300, 14};
constexpr int kTextHeight = 16;
constexpr int kSwatchDistance = 340;
constexpr int kSwatchWidth = 24;  // with the gap
constexpr Rectangle kSourceLegend{20, 856, 1560, 44};

constexpr Colour kPage{24, 26, 31};
constexpr Colour kPanel{13, 14, 17};
constexpr Colour kFreeGround{58, 63, 72};
// Black and white must both stand out.
constexpr Colour kCostPanel{46, 66, 98};
constexpr Colour kCostFreeGround{66, 90, 128};
constexpr Colour kNoCost{214, 40, 40};
constexpr Colour kText{226, 228, 232};
constexpr Colour kFaintText{150, 155, 164};
// Even steps of lightness from low to high, so that heights also read in grey.
constexpr std::array<Colour, 6> kHeightColours = {{{64, 62, 140},
                                                   {44, 106, 160},
                                                   {34, 146, 142},
                                                   {82, 184, 104},
                                                   {176, 214, 72},
                                                   {252, 232, 96}}};

constexpr double kDegree = 3.14159265358979323846 / 180.0;

Colour height_colour(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (kHeightColours.size() - 1);
  const auto step = std::min(static_cast<std::size_t>(place), kHeightColours.size() - 2);
  const double part = place - static_cast<double>(step);
  const Colour& low = kHeightColours[step];
  const Colour& high = kHeightColours[step + 1];
  const auto mix = [part](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(a * (1.0 - part) + b * part);
  };
  return {mix(low.red, high.red), mix(low.green, high.green), mix(low.blue, high.blue)};
}

// NaN without data.
Colour cost_colour(float cost) {
  if (std::isnan(cost)) return kNoCost;
  const auto grey = static_cast<std::uint8_t>(std::lround(cost * 255.0F));
  return {grey, grey, grey};
}

Eigen::Vector3d centre_of(const VoxelKey& key) {
  return Eigen::Vector3d(key.x, key.y, key.z) + Eigen::Vector3d::Constant(0.5);
}

struct LegendEntry {
  Colour colour;
  std::string meaning;
};

using StateOf = std::function<VoxelState(const VoxelKey&)>;

// Points from the occupied neighbours to the free ones; zero when they are balanced.
Eigen::Vector3f normal_of(const StateOf& state_of, const VoxelKey& key) {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3i step(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (step.isZero()) continue;
    const VoxelState state =
        state_of(VoxelKey{key.x + step.x(), key.y + step.y(), key.z + step.z()});
    const float weight = state == VoxelState::kFree       ? 1.0F
                         : state == VoxelState::kOccupied ? -1.0F
                                                          : 0.0F;
    normal += weight * step.cast<float>() / static_cast<float>(step.squaredNorm());
  }
  return normal.squaredNorm() > 0.5F ? normal.normalized() : Eigen::Vector3f::Zero();
}

std::string metres(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f m", decimals, value);
  return text.data();
}

// 1234567 as "1 234 567".
std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, 1, ' ');
  return text;
}

// Largest of 1, 2, 5 times a power of ten that is at most `limit`.
double round_length(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  return power * (limit >= 5.0 * power ? 5.0 : limit >= 2.0 * power ? 2.0 : 1.0);
}

class MapPicture {
 public:
  MapPicture(const ExportedMap& map, const MapPlace& place, StateOf state_of,
             PictureColours colours)
      : map_(map), place_(place), state_of_(std::move(state_of)), colours_(colours) {}

  Image draw() {
    draw_title();
    for (const Rectangle& panel : {kTopPanel, kObliquePanel}) {
      image_.fill(panel, shows_cost() ? kCostPanel : kPanel);
    }
    caption(kTopPanel, "from above, without what is 2 m over the ground");
    caption(kObliquePanel, "the same, seen obliquely");
    if (!place_.bounds) return std::move(image_);
    const MapRelief relief(map_, *place_.bounds);
    if (!relief.extent()) return std::move(image_);
    draw_views(relief, *relief.extent());
    if (shows_source()) {
      draw_source_legend();
    } else {
      draw_legend(*relief.extent());
    }
    return std::move(image_);
  }

 private:
  void draw_title() {
    const MapCounts& counts = map_.counts;
    image_.draw_text(20, 18, "warren map", kText, 3);
    image_.draw_text(230, 23,
                     "resolution " + metres(map_.resolution_m, 3) + ",  " +
                         grouped(counts.occupied) + " occupied and " + grouped(counts.free) +
                         " free voxels",
                     kFaintText);
  }

  void caption(const Rectangle& panel, const std::string& text) {
    image_.draw_text(panel.left, panel.top - kTextHeight - 6, text, kFaintText);
  }

  void draw_views(const MapRelief& relief, const KeyBox& extent) {
    const Eigen::AlignedBox3d box(centre_of(extent.low), centre_of(extent.high));
    SplatView top(Camera(90.0 * kDegree, 90.0 * kDegree), box, kTopPanel.width, kTopPanel.height);
    SplatView oblique(Camera(60.0 * kDegree, 40.0 * kDegree), box, kObliquePanel.width,
                      kObliquePanel.height);
    relief.for_each_free_cell([&](const VoxelKey& key, std::int32_t edge) {
      top.add_ground(centre_of(key), edge, free_ground());
      oblique.add_ground(centre_of(key), edge, free_ground());
    });
    map_.for_each_known([&](const ExportedVoxel& voxel) {
      const VoxelKey& key = voxel.key;
      if (voxel.state != VoxelState::kOccupied || !relief.is_shown(key)) return;
      // Light and shade would change what a cost or a source looks like.
      const Eigen::Vector3f normal =
          colours_ == PictureColours::kHeight ? normal_of(state_of_, key) : Eigen::Vector3f::Zero();
      const Colour colour = colour_of(voxel, extent);
      top.add_cube(centre_of(key), 1.0, normal, colour);
      oblique.add_cube(centre_of(key), 1.0, normal, colour);
    });
    top.draw_to(image_, kTopPanel.left, kTopPanel.top);
    oblique.draw_to(image_, kObliquePanel.left, kObliquePanel.top);
    draw_scale(kTopPanel, top.pixels_per_voxel() / map_.resolution_m, "x right, y up");
    draw_scale(kObliquePanel, oblique.pixels_per_voxel() / map_.resolution_m, "left to right only");
  }

  void draw_scale(const Rectangle& panel, double pixels_per_m, const std::string& note) {
    const double length_m = round_length(panel.width / 4.0 / pixels_per_m);
    const int length = static_cast<int>(std::lround(length_m * pixels_per_m));
    const int top = panel.top + panel.height + 14;
    image_.fill({panel.left, top, length, 4}, kText);
    image_.fill({panel.left, top - 5, 2, 14}, kText);
    image_.fill({panel.left + length - 2, top - 5, 2, 14}, kText);
    const std::string text = metres(length_m, length_m < 1.0 ? 2 : 0);
    image_.draw_text(panel.left + length + 12, top - 6, text, kText);
    image_.draw_text(panel.left + length + 24 + Image::text_width(text), top - 6, note, kFaintText);
  }

  void draw_legend(const KeyBox& extent) {
    for (int x = 0; x < kLegend.width; ++x) {
      const double share = static_cast<double>(x) / (kLegend.width - 1);
      image_.fill({kLegend.left + x, kLegend.top, 1, kLegend.height},
                  shows_cost() ? cost_colour(static_cast<float>(share)) : height_colour(share));
    }
    const std::string low =
        shows_cost() ? "cost 0, easy" : std::string("height ").append(height(extent.low.z));
    const std::string high = shows_cost() ? "1" : height(extent.high.z);
    image_.draw_text(kLegend.left - 12 - Image::text_width(low), kLegend.top - 1, low, kText);
    image_.draw_text(kLegend.left + kLegend.width + 12, kLegend.top - 1, high, kText);
    draw_swatch(kTopPanel.left, kLegend.top, {free_ground(), "free, ground not seen"});
    if (!shows_cost()) return;
    draw_swatch(kTopPanel.left + kSwatchDistance, kLegend.top, {kNoCost, "no data"});
  }

  void draw_swatch(int left, int top, const LegendEntry& entry) {
    image_.fill({left, top, kLegend.height, kLegend.height}, entry.colour);
    image_.draw_text(left + kSwatchWidth, top - 1, entry.meaning, kFaintText);
  }

  // Two lines, as many names as these hold.
  void draw_source_legend() {
    std::vector<LegendEntry> entries = {{free_ground(), "free, ground not seen"},
                                        {colour_of_source(0), "this robot"}};
    const std::size_t others = map_.others ? map_.others->size() : 0;
    const std::size_t named = std::min(others, kSourceColours - 1);
    for (std::size_t i = 0; i < named; ++i) {
      entries.push_back({colour_of_source(static_cast<SourceNumber>(i + 1)),
                         short_name_of((*map_.others)[i], map_.other_names[i])});
    }
    if (others > named) {
      entries.push_back({colour_of_source(static_cast<SourceNumber>(named + 1)),
                         std::to_string(others - named) + " more"});
    }
    draw_entries(entries);
  }

  void draw_entries(const std::vector<LegendEntry>& entries) {
    int left = kSourceLegend.left;
    int top = kSourceLegend.top;
    for (const LegendEntry& entry : entries) {
      const int width = kSwatchWidth + Image::text_width(entry.meaning);
      if (left + width > kSourceLegend.left + kSourceLegend.width) {
        left = kSourceLegend.left;
        top += kSourceLegend.height / 2;
      }
      if (top >= kSourceLegend.top + kSourceLegend.height) return;
      draw_swatch(left, top, entry);
      left += width + kSwatchWidth;
    }
  }

  bool shows_source() const { return colours_ == PictureColours::kSource; }
  bool shows_cost() const { return colours_ == PictureColours::kCost; }
  Colour free_ground() const { return shows_cost() ? kCostFreeGround : kFreeGround; }

  Colour colour_of(const ExportedVoxel& voxel, const KeyBox& extent) const {
    if (shows_cost()) return cost_colour(voxel.cost);
    if (shows_source()) return colour_of_source(voxel.source);
    return height_colour(static_cast<double>(voxel.key.z - extent.low.z) /
                         std::max(1, extent.high.z - extent.low.z));
  }

  std::string height(std::int32_t key_z) const {
    const double in_map = static_cast<double>(place_.origin.z + key_z) + 0.5;
    return metres(in_map * map_.resolution_m, 1);
  }

  const ExportedMap& map_;
  MapPlace place_;
  StateOf state_of_;
  PictureColours colours_;
  Image image_{kWidth, kHeight, kPage};
};

}  // namespace

WriteResult write_map_picture(const MapSnapshot& map, const std::filesystem::path& file,
                              PictureColours colours) {
  const ExportedMap voxels = exported(map);
  const auto state_of = [&map](const VoxelKey& key) { return map.voxels.state(key); };
  return write_png(MapPicture(voxels, place_of(map), state_of, colours).draw(), file);
}

WriteResult write_map_picture(const MergedSnapshot& map, const std::filesystem::path& file,
                              PictureColours colours) {
  const ExportedMap voxels = exported(map);
  const auto state_of = [&map](const VoxelKey& key) { return map.state(key); };
  return write_png(MapPicture(voxels, place_of(map), state_of, colours).draw(), file);
}

}  // namespace warren
