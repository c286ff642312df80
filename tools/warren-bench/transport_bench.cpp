// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/transport_bench.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <thread>

#include <unistd.h>

#include "tools/warren-bench/transport_run.hpp"

namespace warren {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <typename F>
double median_by(const std::vector<TransportRun>& runs, F&& figure) {
  std::vector<double> values;
  values.reserve(runs.size());
  for (const TransportRun& run : runs) values.push_back(figure(run));
  return median(std::move(values));
}

template <typename F>
std::optional<double> median_if_any(const std::vector<TransportRun>& runs, F&& figure) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double value =
      median_by(runs, [&](const TransportRun& run) { return figure(run).value_or(kNone); });
  return std::isinf(value) ? std::nullopt : std::optional(value);
}

}  // namespace

double ideal_s(const TransportOptions& options) {
  return 8.0 * static_cast<double>(options.bytes) / (options.rate_bit_s * (1.0 - options.loss));
}

double time_limit_s(const TransportOptions& options) {
  return options.limit_s.value_or(5.0 * ideal_s(options) + 3.0 * options.blackout_s + 20.0);
}

TransportRun median_of(const std::vector<TransportRun>& runs) {
  using Run = const TransportRun&;
  TransportRun middle;
  for (Run run : runs) {
    middle.available = middle.available && run.available;
    if (middle.problem.empty()) middle.problem = run.problem;
  }
  middle.seconds = median_if_any(runs, [](Run run) { return run.seconds; });
  middle.first_byte_s = median_if_any(runs, [](Run run) { return run.first_byte_s; });
  middle.rival_efficiency = median_if_any(runs, [](Run run) { return run.rival_efficiency; });
  middle.share = median_if_any(runs, [](Run run) { return run.share; });
  middle.efficiency = median_by(runs, [](Run run) { return run.efficiency; });
  middle.oversend = median_by(runs, [](Run run) { return run.oversend; });
  middle.back_share = median_by(runs, [](Run run) { return run.back_share; });
  middle.sender_cpu = median_by(runs, [](Run run) { return run.sender_cpu; });
  middle.receiver_cpu = median_by(runs, [](Run run) { return run.receiver_cpu; });
  for (Run run : runs) {
    middle.link_late_ms_max = std::max(middle.link_late_ms_max, run.link_late_ms_max);
  }
  return middle;
}

tl::expected<std::vector<TransportResult>, std::string> bench_transport(
    const TransportOptions& options) {
  if (geteuid() != 0) return tl::unexpected(std::string("transport: namespaces need root"));
  TransportPrograms programs;
  programs.bench = std::filesystem::read_symlink("/proc/self/exe");
  programs.link = programs.bench.parent_path() / "warren-link";
  if (!std::filesystem::exists(programs.link)) {
    return tl::unexpected("transport: no " + programs.link.string());
  }
  const auto runs = static_cast<std::size_t>(options.runs);
  std::vector<TransportResult> results;
  for (const std::string& peer : options.peers) {
    TransportResult& result = results.emplace_back();
    result.peer = peer;
    result.runs.resize(runs);
  }
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < runs * results.size(); i = next++) {
      TransportResult& result = results[i % results.size()];
      const std::size_t run = i / results.size();
      result.runs[run] = run_transport(options, result.peer, options.seed + run, programs);
    }
  };
  std::vector<std::jthread> workers;
  workers.reserve(static_cast<std::size_t>(options.jobs));
  for (int i = 0; i < options.jobs; ++i) workers.emplace_back(work);
  workers.clear();
  for (TransportResult& result : results) result.median = median_of(result.runs);
  return results;
}

}  // namespace warren
