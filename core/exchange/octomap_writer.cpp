// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/octomap_writer.hpp"

#include <fstream>
#include <limits>

#include <octomap/OcTree.h>

namespace warren {
namespace {

void set_sensor_model(octomap::OcTree& tree, const SensorModel& model) {
  tree.setProbHit(model.hit);
  tree.setProbMiss(model.miss);
  tree.setClampingThresMin(model.minimum);
  tree.setClampingThresMax(model.maximum);
}

octomap::OcTreeKey key_in_tree(const VoxelKey& key, const LayerOrigin& shift) {
  const auto axis = [](std::int64_t moved) {
    return static_cast<octomap::key_type>(moved - kKeyMin);
  };
  return {axis(key.x + shift.x), axis(key.y + shift.y), axis(key.z + shift.z)};
}

void fill(octomap::OcTree& tree, const ExportedMap& map, const LayerOrigin& shift) {
  map.for_each_known([&](const ExportedVoxel& voxel) {
    tree.setNodeValue(key_in_tree(voxel.key, shift), voxel.log_odds, true);
  });
  tree.updateInnerOccupancy();
  tree.prune();
}

// OctoMap's own writers for streams put a line on the console per file, hence the headers here.
void write_header(const octomap::OcTree& tree, const char* first_line, std::ostream& stream) {
  stream.precision(std::numeric_limits<double>::max_digits10);
  stream << first_line << "\nid " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
         << tree.getResolution() << "\ndata\n";
}

}  // namespace

WriteResult write_octomap(const ExportedMap& map, const LayerOrigin& shift, OctomapFormat format,
                          const std::filesystem::path& file) {
  octomap::OcTree tree(map.resolution_m);
  set_sensor_model(tree, map.sensor_model);
  fill(tree, map, shift);
  std::ofstream stream(file, std::ios::binary);
  if (format == OctomapFormat::kBinary) {
    tree.toMaxLikelihood();
    tree.prune();
    write_header(tree, "# Octomap OcTree binary file", stream);
    tree.writeBinaryData(stream);
  } else {
    write_header(tree, "# Octomap OcTree file", stream);
    tree.writeData(stream);
  }
  stream.close();
  if (!stream) return tl::make_unexpected(std::string("the disk refused the data"));
  return {};
}

}  // namespace warren
