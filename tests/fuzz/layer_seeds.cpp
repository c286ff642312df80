// SPDX-License-Identifier: Apache-2.0
// Writes the seeds of fuzz_diff_packet and fuzz_layer_file. Usage: layer_seeds tests/fuzz/corpus
#include <cassert>
#include <filesystem>
#include <fstream>
#include <random>
#include <span>

#include "core/exchange/layer_file.hpp"

namespace {

using namespace warren;

constexpr LayerId kLayer{1, 1, 1};

void write(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

// Without its checksum, which the fuzz target adds.
void write_layer_seed(const std::filesystem::path& file, const Replica& layer) {
  const auto bytes = encode_layer(layer);
  write(file, std::span(bytes).first(bytes.size() - sizeof(Hash)));
}

BlockCodes floor_codes() {
  BlockCodes codes;
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const VoxelKey at = place_of_morton9(place);
    if (at.z > 3) codes.set(place, VoxelCode::free());
    if (at.z == 3) codes.set(place, VoxelCode::occupied(static_cast<CostCode>(at.x), at.y > 5));
  }
  return codes;
}

BlockCodes noise_codes() {
  std::mt19937 random(1);
  BlockCodes codes;
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const auto dice = static_cast<std::uint32_t>(random());
    const auto cost = static_cast<CostCode>(dice >> 8 & 15);
    if (dice % 3 == 1) codes.set(place, VoxelCode::free());
    if (dice % 3 == 2) codes.set(place, VoxelCode::occupied(cost, (dice >> 12 & 1) != 0));
  }
  return codes;
}

}  // namespace

int main(int argc, char** argv) {
  assert(argc == 2);
  const std::filesystem::path corpus(argv[1]);
  const std::filesystem::path packets = corpus / "fuzz_diff_packet";
  const std::filesystem::path layers = corpus / "fuzz_layer_file";
  std::filesystem::create_directories(packets);
  std::filesystem::create_directories(layers);

  Replica layer(kLayer, kDefaultResolution);
  write_layer_seed(layers / "empty", layer);
  layer.publish(
      {{CodedBlock{5, CodeBlock(floor_codes())}, CodedBlock{6, CodeBlock(floor_codes())}}});
  write(packets / "first", layer.encode({{}, {}})->bytes);
  layer.publish({{CodedBlock{700, CodeBlock(noise_codes())}}});
  write(packets / "noise", layer.encode({{}, {1}})->bytes);
  layer.publish({{CodedBlock{5, {}}}});
  write(packets / "emptied", layer.encode({{}, {2}})->bytes);
  write(packets / "nothing", layer.encode({{1000, 2000}, {}})->bytes);
  write(packets / "all", layer.encode({{}, {}})->bytes);
  write_layer_seed(layers / "whole", layer);

  Replica partial(kLayer, kDefaultResolution);
  partial.apply(kLayer, layer.encode({{100, 800}, {}})->bytes);
  partial.pose().update_origin({1, 1, Pose{{1.0, 2.0, 3.0}, Eigen::Quaterniond::Identity()}});
  write_layer_seed(layers / "partial", partial);
  return 0;
}
