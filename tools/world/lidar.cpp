// SPDX-License-Identifier: Apache-2.0
#include "tools/world/lidar.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace warren::world {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kNoHit_m = std::numeric_limits<float>::infinity();

// From the makers' data sheets, ranges at 80 % reflectivity.
struct Sheet {
  const char* name;
  std::uint32_t beams;
  float half_field_deg;
  float max_range_m;
};
constexpr std::array kSheets{Sheet{"os1-64", 64, 22.5F, 100.0F},
                             Sheet{"os0-128", 128, 45.0F, 50.0F},
                             Sheet{"os1-128", 128, 22.5F, 100.0F}};

LidarModel model_of(const Sheet& sheet) {
  LidarModel model;
  model.name = sheet.name;
  model.max_range_m = sheet.max_range_m;
  const float half_rad = sheet.half_field_deg * std::numbers::pi_v<float> / 180.0F;
  for (std::uint32_t beam = 0; beam < sheet.beams; ++beam)
    model.elevations_rad.push_back(
        half_rad * (1.0F - 2.0F * static_cast<float>(beam) / static_cast<float>(sheet.beams - 1)));
  return model;
}

// Unit, sensor frame. One rotation per column saves a sine and a cosine per ray.
std::vector<Eigen::Vector3f> beams_straight_ahead(const LidarModel& model) {
  std::vector<Eigen::Vector3f> beams;
  for (const float elevation : model.elevations_rad)
    beams.emplace_back(std::cos(elevation), 0.0F, std::sin(elevation));
  return beams;
}

Eigen::Matrix3d azimuth_of(const LidarModel& model, std::uint32_t column) {
  const double turn = static_cast<double>(column + 1) / model.columns;
  return Eigen::AngleAxisd(-2.0 * std::numbers::pi * turn, Eigen::Vector3d::UnitZ())
      .toRotationMatrix();
}

// What the world does to a ray, before the sensor's own faults.
float true_range_m(const Caster& caster, const std::vector<Cylinder>& cylinders, Ray ray) {
  float range_m = caster.range_m(ray);
  ray.max_range_m = std::min(ray.max_range_m, range_m);
  if (const auto body_m = cast(cylinders, ray)) range_m = *body_m;
  return range_m;
}

// NaN if the sensor reports nothing.
float measured_range_m(const LidarModel& model, float range_m, Random& random) {
  if (range_m == kNoHit_m || (model.dropout > 0.0 && random.chance(model.dropout))) return kNaN;
  if (model.range_noise_m > 0.0F)
    range_m += model.range_noise_m * static_cast<float>(random.normal());
  return range_m >= model.min_range_m && range_m <= model.max_range_m ? range_m : kNaN;
}

struct Column {
  Eigen::Isometry3f T_world_column;  // turned to the column's azimuth
  Eigen::Isometry3f T_out_column;    // to the frame that the points are delivered in
  std::vector<Cylinder> cylinders;
};

void cast_column(const Caster& caster, const LidarModel& model,
                 const std::vector<Eigen::Vector3f>& beams, const Column& column, Random& random,
                 std::vector<Point3f>& points) {
  for (const Eigen::Vector3f& beam : beams) {
    const Ray ray{.origin = column.T_world_column.translation(),
                  .direction = column.T_world_column.linear() * beam,
                  .max_range_m = model.max_range_m};
    const float range_m =
        measured_range_m(model, true_range_m(caster, column.cylinders, ray), random);
    const Eigen::Vector3f point = column.T_out_column * (range_m * beam);
    points.push_back(std::isnan(range_m) ? Point3f{kNaN, kNaN, kNaN}
                                         : Point3f{point.x(), point.y(), point.z()});
  }
}

}  // namespace

std::optional<LidarModel> lidar_of(std::string_view name) {
  for (const Sheet& sheet : kSheets)
    if (sheet.name == name) return model_of(sheet);
  return std::nullopt;
}

std::vector<std::string> lidar_names() {
  std::vector<std::string> names;
  names.reserve(kSheets.size());
  for (const Sheet& sheet : kSheets) names.emplace_back(sheet.name);
  return names;
}

Sweep sweep(const Surroundings& surroundings, const LidarModel& model, const SensorMotion& motion,
            double end_s, Deskew deskew, Random& random) {
  Sweep sweep{.points_sensor = {}, .T_world_sensor = motion(end_s), .end_s = end_s};
  sweep.points_sensor.reserve(model.columns * model.elevations_rad.size());
  const std::vector<Eigen::Vector3f> beams = beams_straight_ahead(model);
  const Eigen::Isometry3d T_end_world = sweep.T_world_sensor.inverse();
  for (std::uint32_t index = 0; index < model.columns; ++index) {
    const double time_s = end_s - model.column_s() * (model.columns - 1 - index);
    const Eigen::Isometry3d T_sensor_column(azimuth_of(model, index));
    const Eigen::Isometry3d T_world_column = motion(time_s) * T_sensor_column;
    const Eigen::Isometry3d T_out_column =
        deskew == Deskew::kYes ? T_end_world * T_world_column : T_sensor_column;
    const Column column{T_world_column.cast<float>(), T_out_column.cast<float>(),
                        surroundings.bodies.at(time_s)};
    cast_column(surroundings.caster, model, beams, column, random, sweep.points_sensor);
  }
  return sweep;
}

}  // namespace warren::world
