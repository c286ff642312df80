// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/warren-bench/machine.hpp"
#include "tools/warren-bench/peers_bench.hpp"

namespace warren {

std::string to_json(const PeersResult& result, const PeersOptions& options) {
  using Json = nlohmann::ordered_json;
  const Machine machine = this_machine();
  const auto& caught_up = result.caught_up_after_s;
  const Json json{
      {"benchmark", "peers"},
      {"machine",
       {{"cpu", machine.cpu}, {"cpu_level", machine.cpu_level}, {"build", machine.build}}},
      {"robots", options.robots},
      {"tick_s", options.tape.tick_s},
      {"columns", options.tape.columns},
      {"scan_hz", options.tape.scan_hz},
      {"resolution_m", options.tape.resolution_m},
      {"max_range_m", options.tape.max_range_m},
      {"seconds", result.seconds},
      {"ticks", result.ticks},
      {"ticks_late", result.ticks_late},
      {"voxels", result.voxels},
      {"bytes_sent", result.bytes_sent},
      {"caught_up_after_s", caught_up ? Json(*caught_up) : Json()},
      {"digests_equal", result.digests_equal},
      {"cores", result.cores}};
  return json.dump(2);
}

std::string to_text(const PeersResult& result) {
  const std::string caught_up =
      result.caught_up_after_s ? fmt::format("{:.2f} s", *result.caught_up_after_s) : "not in time";
  return fmt::format(
      "{} ticks in {:.1f} s, {} of them late; {} voxels, {:.1f} kB/s sent; caught up after: {}; "
      "digests equal: {}; {:.3f} cores\n",
      result.ticks, result.seconds, result.ticks_late, result.voxels,
      static_cast<double>(result.bytes_sent) / 1000.0 / result.seconds, caught_up,
      result.digests_equal, result.cores);
}

}  // namespace warren
