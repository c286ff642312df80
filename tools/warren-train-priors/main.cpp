// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "core/exchange/cloud_reader.hpp"
#include "core/layer/packet_header.hpp"
#include "tools/warren-train-priors/cli.hpp"
#include "tools/warren-train-priors/prior_counts.hpp"
#include "tools/warren-train-priors/tick_recording.hpp"

namespace warren {
namespace {

const std::vector<MapSetting> kSettings = {{0.15, 10.0}, {0.2, 7.0}};
constexpr std::size_t kBytesPerRow = 46;

// The ways that a recording can reach its peers.
void count_packets(const Ticks& ticks, PriorCounts& counts) {
  const PacketSink count = [&](const auto& packet) { counts.add(packet); };
  for (const bool held : {false, true}) {
    const SenderRules rules{held, held};
    for (const std::size_t seconds : {std::size_t{1}, std::size_t{10}}) {
      send_ticks(merge_ticks(ticks, seconds), rules, false, count);
    }
    send_ticks(ticks, rules, true, count);
  }
}

// An error, or nothing.
std::string count_all(const TrainOptions& options, PriorCounts& counts) {
  for (const std::string& preset : options.worlds) {
    for (const std::uint64_t seed : options.seeds) {
      const std::uint64_t before = counts.bytes();
      const auto recordings = record_ticks({preset, seed}, options.seconds, kSettings);
      if (!recordings) return recordings.error();
      for (const Ticks& ticks : *recordings) count_packets(ticks, counts);
      fmt::print("{} {}: {} bytes\n", preset, seed, counts.bytes() - before);
    }
  }
  for (const auto& path : options.clouds) {
    const auto files = list_clouds(path);
    if (!files) return files.error();
    for (const auto& file : *files) {
      const auto ticks = record_cloud(file, kSettings.front());
      if (!ticks) return ticks.error();
      count_packets(*ticks, counts);
    }
  }
  return {};
}

bool write_table(const std::vector<std::uint8_t>& table, const std::filesystem::path& path) {
  std::ofstream out(path);
  out << "// SPDX-License-Identifier: Apache-2.0\n// Made by warren-train-priors for packet "
         "version "
      << int{kPacketVersion} << "; not to be edited.\n";
  for (std::size_t first = 0; first < table.size(); first += kBytesPerRow) {
    out << '"';
    for (std::size_t i = first; i < std::min(table.size(), first + kBytesPerRow); ++i) {
      out << fmt::format("{:02x}", table[i]);
    }
    out << "\",\n";
  }
  out.close();
  return !out.fail();
}

int run(const TrainOptions& options) {
  PriorCounts counts;
  if (const std::string error = count_all(options, counts); !error.empty()) {
    fmt::print(stderr, "warren-train-priors: {}\n", error);
    return 1;
  }
  if (!write_table(counts.table(), options.out)) {
    fmt::print(stderr, "warren-train-priors: cannot write {}\n", options.out.string());
    return 1;
  }
  fmt::print("{} packets of {} bytes counted; written: {}\n", counts.packets(), counts.bytes(),
             options.out.string());
  return 0;
}

}  // namespace
}  // namespace warren

int main(int argc, char** argv) {
  const auto parsed = warren::parse_command_line(argc, argv);
  if (const int* status = std::get_if<int>(&parsed)) return *status;
  return warren::run(std::get<warren::TrainOptions>(parsed));
}
