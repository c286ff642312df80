// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/map_writer.hpp"

#include <optional>
#include <utility>

#include "core/exchange/atomic_file.hpp"
#include "core/exchange/cloud_writer.hpp"
#include "core/exchange/file_ending.hpp"
#include "core/exchange/map_frame.hpp"
#include "core/exchange/octomap_writer.hpp"

namespace warren {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMapEndings = ".bt, .ot, .ply, .pcd or .png";

// What a file of some format will hold, and how it is written.
struct Job {
  std::uint64_t voxels = 0;
  std::string note;
  std::function<WriteResult(const fs::path&)> write;
};

Job tree_job(ExportedMap map, FileFrame frame, OctomapFormat format) {
  const std::uint64_t voxels = map.counts.free + map.counts.occupied;
  return {voxels, std::move(frame.note),
          [map = std::move(map), shift = frame.shift, format](const fs::path& file) {
            return write_octomap(map, shift, format, file);
          }};
}

Job cloud_job(ExportedMap map, FileFrame frame, decltype(&write_ply) write) {
  const std::uint64_t voxels = map.counts.occupied;
  return {voxels, std::move(frame.note),
          [map = std::move(map), shift = frame.shift, write](const fs::path& file) {
            return write(map, shift, file);
          }};
}

template <typename Map>
Job picture_job(const Map& map, const MapCounts& counts, PictureColours colours) {
  return {counts.free + counts.occupied, "",
          [&map, colours](const fs::path& file) { return write_map_picture(map, file, colours); }};
}

// Of a robot's own map or a merged one.
template <typename Map>
std::optional<Job> job_for(const std::string& ending, const Map& map, PictureColours colours) {
  const ExportedMap voxels = exported(map);
  const MapPlace place = place_of(map);
  if (ending == ".bt") return tree_job(voxels, frame_for_tree(place), OctomapFormat::kBinary);
  if (ending == ".ot") return tree_job(voxels, frame_for_tree(place), OctomapFormat::kFull);
  if (ending == ".ply") return cloud_job(voxels, frame_for_cloud(place), write_ply);
  if (ending == ".pcd") return cloud_job(voxels, frame_for_cloud(place), write_pcd);
  if (ending == ".png") return picture_job(map, voxels.counts, colours);
  return std::nullopt;
}

// In the layer frame, whose keys fit any format.
std::optional<Job> job_for(const std::string& ending, const Replica& layer) {
  if (ending == ".bt") return tree_job(exported(layer), {}, OctomapFormat::kBinary);
  if (ending == ".ot") return tree_job(exported(layer), {}, OctomapFormat::kFull);
  if (ending == ".ply") return cloud_job(exported(layer), {}, write_ply);
  if (ending == ".pcd") return cloud_job(exported(layer), {}, write_pcd);
  return std::nullopt;
}

tl::expected<SaveReport, std::string> done(const std::optional<Job>& job, const fs::path& file,
                                           const char* endings) {
  if (!job) {
    return tl::make_unexpected("cannot write " + file.string() + ": the ending must be " + endings);
  }
  const auto bytes = write_atomically(file, job->write);
  if (!bytes) return tl::make_unexpected(bytes.error());
  return SaveReport{lower_case_ending(file).substr(1), *bytes, job->voxels, job->note};
}

}  // namespace

tl::expected<SaveReport, std::string> save_map(const MapSnapshot& map, const fs::path& file,
                                               PictureColours colours) {
  return done(job_for(lower_case_ending(file), map, colours), file, kMapEndings);
}

tl::expected<SaveReport, std::string> save_merged_map(const MergedSnapshot& map,
                                                      const fs::path& file,
                                                      PictureColours colours) {
  return done(job_for(lower_case_ending(file), map, colours), file, kMapEndings);
}

tl::expected<SaveReport, std::string> export_layer(const Replica& layer, const fs::path& file) {
  return done(job_for(lower_case_ending(file), layer), file, ".bt, .ot, .ply or .pcd");
}

}  // namespace warren
