// SPDX-License-Identifier: Apache-2.0
#include "tools/link/trace_files.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>

#include "tools/world/number_text.hpp"

namespace warren {
namespace {

constexpr std::size_t kLinesMax = 10'000'000;
constexpr std::size_t kNodesMax = 1000;
constexpr double kSecondsMax = 1e7;
constexpr std::size_t kRutgersPackets = 300;
constexpr auto kRutgersPeriod = std::chrono::milliseconds(100);
constexpr unsigned kRutgersBadRssi = 128;

constexpr std::string_view kLinkHeader = "time_s,rate_bit_s,loss,delay_ms";
constexpr std::string_view kRadioHeader = "time_s,from,to,loss,rate_bit_s";

using Result = tl::expected<TraceFile, std::string>;
using Lines = std::vector<std::string>;

Result fail(std::size_t line, std::string_view what) {
  return tl::unexpected("line " + std::to_string(line + 1) + ": " + std::string(what));
}

// A number in [0, most].
std::optional<double> share_of(std::string_view text, double most) {
  const auto value = number_in<double>(text);
  if (!value || !(*value >= 0.0 && *value <= most)) return {};
  return value;
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.push_back(line.substr(0, end));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

Duration seconds(double time_s) { return Duration(std::llround(time_s * 1e6)); }

std::optional<Lines> lines_of(std::istream& in) {
  Lines lines;
  for (std::string line; std::getline(in, line);) {
    if (lines.size() == kLinesMax) return {};
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

// The first rate holds from the start, whenever it was told; then only changes are kept.
void add_rate(std::vector<RateStep>& rates, Duration at, double bit_s) {
  if (rates.empty()) {
    rates.push_back({Duration{}, bit_s});
  } else if (rates.back().bit_s != bit_s) {
    rates.push_back({at, bit_s});
  }
}

Result read_link_trace(const Lines& lines) {
  LinkTrace trace;
  std::optional<Duration> last;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto fields = split(lines[i], ',');
    if (fields.size() != 4) return fail(i, "not four fields");
    const auto time_s = share_of(fields[0], kSecondsMax);
    if (!time_s || (last && seconds(*time_s) <= *last)) return fail(i, "time does not rise");
    last = seconds(*time_s);
    const auto rate = share_of(fields[1], 1e12);
    const auto loss = share_of(fields[2], 1.0);
    const auto delay_ms = share_of(fields[3], 1e7);
    if ((!rate && !fields[1].empty()) || (!loss && !fields[2].empty()) ||
        (!delay_ms && !fields[3].empty())) {
      return fail(i, "a number is missing or out of range");
    }
    if (rate) add_rate(trace.rates, *last, *rate);
    if (!loss && !delay_ms) continue;
    trace.steps.push_back({*last, loss, {}});
    if (delay_ms) trace.steps.back().delay = seconds(*delay_ms / 1000.0);
  }
  if (!last) return fail(0, "no step");
  return trace;
}

std::size_t index_of(std::vector<std::string>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  names.emplace_back(name);
  return names.size() - 1;
}

// Links that were never up have no rate of their own.
void give_rates(RadioTraceFile& file) {
  double slowest = INFINITY;
  for (const auto& link : file.links) {
    for (const RateStep& step : link.trace.rates) slowest = std::min(slowest, step.bit_s);
  }
  if (slowest == INFINITY) return;
  for (auto& link : file.links) {
    if (link.trace.rates.empty()) link.trace.rates = {{Duration{}, slowest}};
  }
}

Result read_radio_trace(const Lines& lines) {
  RadioTraceFile file;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> index;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto fields = split(lines[i], ',');
    if (fields.size() != 5) return fail(i, "not five fields");
    const auto time_s = share_of(fields[0], kSecondsMax);
    const auto loss = share_of(fields[3], 1.0);
    const auto rate = share_of(fields[4], 1e12);
    if (!time_s || !loss || !rate) return fail(i, "a number is missing or out of range");
    const std::size_t from = index_of(file.names, fields[1]);
    const std::size_t to = index_of(file.names, fields[2]);
    if (from == to) return fail(i, "a node hears itself");
    if (file.names.size() > kNodesMax) return fail(i, "too many nodes");
    const auto [place, is_new] = index.try_emplace({from, to}, file.links.size());
    if (is_new) file.links.push_back({from, to, {}});
    LinkTrace& trace = file.links[place->second].trace;
    const Duration at = seconds(*time_s);
    if (!trace.steps.empty() && trace.steps.back().at >= at) return fail(i, "time does not rise");
    trace.steps.push_back({at, *rate > 0.0 ? *loss : 1.0, {}});
    if (*rate > 0.0) add_rate(trace.rates, at, *rate);
  }
  if (file.links.empty()) return fail(0, "no link");
  give_rates(file);
  return file;
}

Result read_opportunities(const Lines& lines) {
  Opportunities list;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto at_ms = number_in<std::uint32_t>(lines[i]);
    if (!at_ms) return fail(i, "not a whole number of milliseconds");
    if (!list.at_ms.empty() && *at_ms < list.at_ms.back()) return fail(i, "time goes back");
    list.at_ms.push_back(*at_ms);
  }
  if (list.at_ms.back() == 0) return fail(lines.size() - 1, "the last time must be above 0");
  return list;
}

Result read_loss_pattern(const Lines& lines) {
  LossPattern pattern{std::vector<bool>(kRutgersPackets, true), kRutgersPeriod};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto fields = split(lines[i], ' ');
    const auto sequence = number_in<std::uint32_t>(fields[0]);
    const auto rssi = fields.size() == 2 ? number_in<std::uint32_t>(fields[1]) : std::nullopt;
    if (!sequence || !rssi || *sequence >= kLinesMax) return fail(i, "not a number and an RSSI");
    if (*sequence >= pattern.lost.size()) pattern.lost.resize(*sequence + 1, true);
    if (*rssi != kRutgersBadRssi) pattern.lost[*sequence] = false;
  }
  return pattern;
}

}  // namespace

tl::expected<TraceFile, std::string> read_trace(std::istream& in) {
  const auto lines = lines_of(in);
  if (!lines) return tl::unexpected(std::string("too many lines"));
  if (lines->empty()) return read_loss_pattern(*lines);
  if (lines->front() == kLinkHeader) return read_link_trace(*lines);
  if (lines->front() == kRadioHeader) return read_radio_trace(*lines);
  if (lines->front().find(' ') != std::string::npos) return read_loss_pattern(*lines);
  return read_opportunities(*lines);
}

tl::expected<TraceFile, std::string> read_trace_file(const std::filesystem::path& path) {
  std::ifstream in(path);
  if (!in) return tl::unexpected("cannot read " + path.string());
  auto trace = read_trace(in);
  if (!trace) return tl::unexpected(path.string() + ", " + trace.error());
  return trace;
}

void apply(const LinkTrace& trace, LinkConfig& link) {
  if (!trace.rates.empty()) link.capacity = Capacity(trace.rates);
  link.steps = trace.steps;
}

void apply(const TraceFile& trace, LinkConfig& link) {
  if (const auto* steps = std::get_if<LinkTrace>(&trace)) apply(*steps, link);
  if (const auto* list = std::get_if<Opportunities>(&trace)) link.capacity = Capacity(*list);
  if (const auto* pattern = std::get_if<LossPattern>(&trace)) link.loss_pattern = *pattern;
}

}  // namespace warren
