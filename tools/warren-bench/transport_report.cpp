// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/warren-bench/machine.hpp"
#include "tools/warren-bench/transport_bench.hpp"

namespace warren {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

// With a rival on the link these are of both.
Json if_alone(const TransportRun& run, double value) { return run.share ? Json() : Json(value); }

Json json_of(const TransportResult& result) {
  const TransportRun& run = result.median;
  if (!run.available) return {{"available", false}, {"problem", run.problem}};
  Json json{{"seconds", number_or_null(run.seconds)},
            {"efficiency", run.efficiency},
            {"oversend", if_alone(run, run.oversend)},
            {"first_byte_s", number_or_null(run.first_byte_s)},
            {"back_share", if_alone(run, run.back_share)},
            {"sender_cpu", run.sender_cpu},
            {"receiver_cpu", run.receiver_cpu},
            {"link_late_ms_max", run.link_late_ms_max},
            {"efficiency_of_runs", Json::array()}};
  if (run.share) {
    json["rival_efficiency"] = number_or_null(run.rival_efficiency);
    json["share"] = *run.share;
  }
  for (const TransportRun& one : result.runs) json["efficiency_of_runs"].push_back(one.efficiency);
  if (!run.problem.empty()) json["problem"] = run.problem;
  return json;
}

std::string text_of(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : "-";
}

}  // namespace

std::string to_json(const std::vector<TransportResult>& results, const TransportOptions& options) {
  const Machine machine = this_machine();
  Json json{{"benchmark", "transport"},
            {"machine",
             {{"cpu", machine.cpu}, {"cpu_level", machine.cpu_level}, {"build", machine.build}}},
            {"bytes", options.bytes},
            {"rate_bit_s", options.rate_bit_s},
            {"rtt_ms", options.rtt_ms},
            {"loss", options.loss},
            {"burst_packets", number_or_null(options.burst_packets)},
            {"blackout_s", options.blackout_s},
            {"queue_ms", options.queue_ms},
            {"limit_s", time_limit_s(options)},
            {"against", options.against ? Json(*options.against) : Json()},
            {"runs", options.runs},
            {"jobs", options.jobs},
            {"seed", options.seed},
            {"peers", Json::object()}};
  for (const TransportResult& result : results) json["peers"][result.peer] = json_of(result);
  return json.dump(2);
}

std::string to_text(const std::vector<TransportResult>& results, const TransportOptions& options) {
  std::string text = fmt::format(
      "{} bytes at {:.0f} bit/s, RTT {} ms, loss {}{}, medians of {}\n"
      "{:<10} {:>9} {:>10} {:>9} {:>12} {:>10}\n",
      options.bytes, options.rate_bit_s, options.rtt_ms, options.loss,
      options.burst_packets ? fmt::format(" in bursts of {}", *options.burst_packets) : "",
      options.runs, "", "seconds", "efficiency", "oversend", "first_byte_s", "back_share");
  for (const TransportResult& result : results) {
    const TransportRun& run = result.median;
    text += fmt::format("{:<10} {:>9} {:>10.3f} {:>9.3f} {:>12} {:>10.3f}  {}\n", result.peer,
                        text_of(run.seconds), run.efficiency, run.oversend,
                        text_of(run.first_byte_s), run.back_share, run.problem);
    if (run.share) {
      text += fmt::format("  beside {}: {:.3f} of the payload bytes; it had {} of the link\n",
                          options.against.value_or(""), *run.share, text_of(run.rival_efficiency));
    }
  }
  return text;
}

}  // namespace warren
