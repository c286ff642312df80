// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/layer_commands.hpp"

#include <array>
#include <iomanip>
#include <iostream>
#include <string>
#include <utility>

#include "core/exchange/file_ending.hpp"
#include "core/exchange/layer_file.hpp"
#include "core/exchange/map_writer.hpp"
#include "core/exchange/octomap_reader.hpp"
#include "core/layer/hash_text.hpp"
#include "core/layer/layer_difference.hpp"
#include "tools/warrenctl/failure.hpp"

namespace warren {
namespace {

constexpr int kDiffer = 1;
constexpr int kDiffFailure = 2;

using CountRow = std::pair<const char*, std::uint64_t>;

std::array<CountRow, 5> rows_of(const LayerDifference& difference) {
  return {{{"only_in_a", difference.only_in_a},
           {"only_in_b", difference.only_in_b},
           {"occupancy", difference.occupancy},
           {"cost", difference.cost},
           {"stair", difference.stair}}};
}

void print_table(const LayerDifference& difference) {
  for (const auto& [name, voxels] : rows_of(difference)) {
    std::cout << std::left << std::setw(12) << name << voxels << "\n";
  }
}

void print_json(const LayerDifference& difference) {
  const char* separator = "{";
  for (const auto& [name, voxels] : rows_of(difference)) {
    std::cout << separator << '"' << name << "\":" << voxels;
    separator = ",";
  }
  std::cout << "}\n";
}

}  // namespace

int run(const LayerExportCommand& command) {
  const auto layer = read_layer(command.layer);
  if (!layer) return failure(layer.error());
  const auto saved = export_layer(*layer, command.file);
  if (!saved) return failure(saved.error());
  std::cout << "wrote " << saved->voxels << " voxels, " << saved->bytes << " bytes, to "
            << command.file.string() << ", in the layer frame\n";
  return 0;
}

int run(const LayerImportCommand& command) {
  const std::string ending = lower_case_ending(command.tree);
  if (ending != ".bt" && ending != ".ot") {
    return failure("cannot read " + command.tree.string() + ": the ending must be .bt or .ot");
  }
  const auto layer = read_octomap(command.tree, command.origin);
  if (!layer) return failure(layer.error());
  if (const auto written = write_layer(*layer, command.layer); !written) {
    return failure(written.error());
  }
  std::cout << "wrote " << command.layer.string() << ", a layer of origin " << command.origin
            << "\n";
  return 0;
}

int run(const LayerDiffCommand& command) {
  const auto a = read_layer(command.a);
  if (!a) return failure(a.error(), kDiffFailure);
  const auto b = read_layer(command.b);
  if (!b) return failure(b.error(), kDiffFailure);
  if (a->resolution() != b->resolution()) {
    return failure("layers of " + std::to_string(a->resolution().micrometres()) + " and " +
                       std::to_string(b->resolution().micrometres()) +
                       " micrometres per voxel cannot be compared",
                   kDiffFailure);
  }
  const LayerDifference difference = difference_of(*a, *b);
  command.json ? print_json(difference) : print_table(difference);
  return difference.any() ? kDiffer : 0;
}

int run(const LayerDigestCommand& command) {
  const auto layer = read_layer(command.layer);
  if (!layer) return failure(layer.error());
  std::cout << hex_of(layer->digest().root()) << "\n";
  if (!command.regions) return 0;
  for (const auto& [region, hash] : layer->digest().regions()) {
    const VoxelKey low = first_voxel_of(block_key_of(keys_of_region(region).first));
    std::cout << hex_of(hash) << "  " << low.x << " " << low.y << " " << low.z << "\n";
  }
  return 0;
}

}  // namespace warren
