// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/map_writer.hpp"

#include <new>
#include <optional>

#include "core/exchange/atomic_file.hpp"
#include "core/exchange/cloud_writer.hpp"
#include "core/exchange/file_ending.hpp"
#include "core/exchange/map_frame.hpp"
#include "core/exchange/octomap_writer.hpp"

namespace warren {
namespace {

namespace fs = std::filesystem;

// What a file of some format will hold, and how it is written.
struct Job {
  std::uint64_t voxels = 0;
  std::string note;
  std::function<WriteResult(const fs::path&)> write;
};

Job tree_job(const MapSnapshot& map, const MapCounts& counts, OctomapFormat format) {
  FileFrame frame = frame_for_tree(map);
  return {counts.free + counts.occupied, std::move(frame.note),
          [&map, shift = frame.shift, format](const fs::path& file) {
            return write_octomap(map, shift, format, file);
          }};
}

Job cloud_job(const MapSnapshot& map, const MapCounts& counts, decltype(&write_ply) write) {
  FileFrame frame = frame_for_cloud(map);
  return {
      counts.occupied, std::move(frame.note),
      [&map, shift = frame.shift, write](const fs::path& file) { return write(map, shift, file); }};
}

Job picture_job(const MapSnapshot& map, const MapCounts& counts, PictureColours colours) {
  return {counts.free + counts.occupied, "",
          [&map, colours](const fs::path& file) { return write_map_picture(map, file, colours); }};
}

std::optional<Job> job_for(const std::string& ending, const MapSnapshot& map,
                           PictureColours colours) {
  const MapCounts counts = map.voxels.counts();
  if (ending == ".bt") return tree_job(map, counts, OctomapFormat::kBinary);
  if (ending == ".ot") return tree_job(map, counts, OctomapFormat::kFull);
  if (ending == ".ply") return cloud_job(map, counts, write_ply);
  if (ending == ".pcd") return cloud_job(map, counts, write_pcd);
  if (ending == ".png") return picture_job(map, counts, colours);
  return std::nullopt;
}

}  // namespace

tl::expected<SaveReport, std::string> save_map(const MapSnapshot& map, const fs::path& file,
                                               PictureColours colours) {
  const std::string ending = lower_case_ending(file);
  const auto job = job_for(ending, map, colours);
  if (!job) {
    return tl::make_unexpected("cannot write " + file.string() +
                               ": the ending must be .bt, .ot, .ply, .pcd or .png");
  }
  const auto bytes = write_atomically(file, job->write);
  if (!bytes) return tl::make_unexpected(bytes.error());
  return SaveReport{ending.substr(1), *bytes, job->voxels, job->note};
}

}  // namespace warren
