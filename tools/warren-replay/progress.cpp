// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-replay/progress.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace warren {
namespace {

constexpr std::size_t kBarWidth = 40;
constexpr std::chrono::milliseconds kRedraw{100};
constexpr std::chrono::milliseconds kNewLine{2000};

std::uint64_t dropped(const ReplaySummary& summary) {
  return summary.dropped_overload + summary.dropped_out_of_order;
}

std::string bar(const ReplaySummary& summary) {
  const std::size_t filled =
      summary.scans == 0 ? kBarWidth : kBarWidth * summary.sent / summary.scans;
  return std::string(filled, '#') + std::string(kBarWidth - filled, '.');
}

}  // namespace

ProgressView::ProgressView(std::FILE* out) : out_(out), terminal_(isatty(fileno(out)) != 0) {}

void ProgressView::show(const ReplaySummary& summary) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + (terminal_ ? kRedraw : kNewLine);
  draw(summary);
}

void ProgressView::finish(const ReplaySummary& summary) {
  draw(summary);
  if (terminal_) std::fputc('\n', out_);
}

void ProgressView::draw(const ReplaySummary& summary) {
  const std::string line =
      fmt::format("[{}] {}/{} sent, {} taken, {} dropped, {} rejected", bar(summary), summary.sent,
                  summary.scans, summary.taken, dropped(summary), summary.rejected);
  fmt::print(out_, "{}{}{}", terminal_ ? "\r" : "", line, terminal_ ? "\x1b[K" : "\n");
  std::fflush(out_);
}

std::string to_text(const ReplaySummary& s) {
  std::string text = fmt::format(
      "sent {} of {} scans ({} points) in {:.1f} s: {} taken, {} dropped by overload, {} out of "
      "order, {} rejected\n",
      s.sent, s.scans, s.points, s.wall_s, s.taken, s.dropped_overload, s.dropped_out_of_order,
      s.rejected);
  if (!s.last_reason.empty()) text += fmt::format("last rejection: {}\n", s.last_reason);
  return text;
}

std::string to_json(const ReplaySummary& s) {
  const nlohmann::ordered_json json = {{"scans", s.scans},
                                       {"sent", s.sent},
                                       {"taken", s.taken},
                                       {"dropped_overload", s.dropped_overload},
                                       {"dropped_out_of_order", s.dropped_out_of_order},
                                       {"rejected", s.rejected},
                                       {"points", s.points},
                                       {"wall_s", s.wall_s},
                                       {"last_reason", s.last_reason},
                                       {"error", s.error}};
  return json.dump(2) + "\n";
}

}  // namespace warren
