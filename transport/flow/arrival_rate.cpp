// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/arrival_rate.hpp"

#include <algorithm>

namespace warren::mesh {
namespace {

constexpr double kStretchMin = 0.2;  // jitter may turn the order about

double us(Duration duration) { return static_cast<double>(duration.count()); }

}  // namespace

void ArrivalRate::on_ack(MeshTime now, const AckFrame& ack, const AckReport& report) {
  // An older acknowledgement that comes late says nothing new of the sums.
  const auto more_bytes = static_cast<std::int32_t>(ack.pair_bytes - last_bytes_);
  if (more_bytes > 0) {
    total_.arrived_bytes += more_bytes;
    total_.arrived_us += static_cast<std::int32_t>(ack.pair_us - last_us_);
    last_bytes_ = ack.pair_bytes;
    last_us_ = ack.pair_us;
  }
  total_.acked_bytes = report.acked_bytes;
  total_.busy_acked_bytes = report.busy_acked_bytes;
  if (report.pairs.pauses != total_.sent.pauses) marks_.clear();
  total_.sent = report.pairs;
  total_.time = now;
  if (!marks_.empty() && now - marks_.back().time < kMarkSpacing) return;
  marks_.push_back(total_);
  if (marks_.size() > kMarksMax) marks_.pop_front();
}

std::optional<ArrivalRate::Measure> ArrivalRate::since(MeshTime time, double pairs,
                                                       MeshTime earliest) const {
  // The youngest mark that is old enough and has enough after it.
  for (auto mark = marks_.rbegin(); mark != marks_.rend(); ++mark) {
    if (mark->time < earliest) return {};
    if (mark->time > time || total_.sent.busy_pairs - mark->sent.busy_pairs < pairs) continue;
    return since(*mark);
  }
  return {};
}

std::optional<ArrivalRate::Measure> ArrivalRate::since(const Mark& from) const {
  if (from.sent.pauses != total_.sent.pauses) return {};
  const double pairs = total_.sent.busy_pairs - from.sent.busy_pairs;
  const double sent_bytes = total_.sent.ip_bytes - from.sent.ip_bytes;
  const double arrived_bytes = total_.arrived_bytes - from.arrived_bytes;
  const double busy = us(total_.sent.busy - from.sent.busy);
  const double busy_own = us(total_.sent.busy_own - from.sent.busy_own);
  const double own = us(total_.sent.own - from.sent.own);
  const double spacing = us(total_.sent.spacing - from.sent.spacing);
  if (pairs < 1.0 || busy_own <= 0.0 || arrived_bytes <= 0.0) return {};
  // Both sides rarely count quite the same pairs: what is in flight differs.
  const double arrived_us = (total_.arrived_us - from.arrived_us) * sent_bytes / arrived_bytes;
  if (arrived_us <= 0.0) return {};
  const double queued_us = arrived_us - spacing;
  Measure measure;
  measure.arrival_rate = sent_bytes * 1e6 / arrived_us * spacing / own;
  measure.busy = busy / spacing;
  measure.pairs = pairs;
  measure.seconds = busy * 1e-6;
  measure.stretch = std::max((busy + queued_us) / busy, kStretchMin);
  measure.bytes = total_.sent.busy_bytes - from.sent.busy_bytes;
  measure.rate = measure.bytes * 1e6 / (busy_own * measure.stretch);
  return measure;
}

}  // namespace warren::mesh
