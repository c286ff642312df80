// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/telemetry_outbox.hpp"

#include <algorithm>
#include <cassert>

namespace warren::mesh {
namespace {

OutgoingFrame frame_of(std::uint16_t key, const TelemetryBoard::Value& value) {
  return {TelemetryFrame{key, value.version, value.bytes}, TelemetryTicket{key, value.version}};
}

}  // namespace

TelemetryOutbox::TelemetryOutbox(const TelemetryBoard& board, OutboxCounts& counts)
    : board_(board), counts_(counts) {
  send_all();
}

void TelemetryOutbox::on_set(std::uint16_t key) {
  assert(board_.values().contains(key));
  if (keys_[key].waiting) ++counts_.telemetry_replaced;
  wait(key);
}

std::optional<OutgoingFrame> TelemetryOutbox::next(std::size_t room, std::size_t whole) {
  for (auto place = waiting_.begin(); place != waiting_.end();) {
    const std::uint16_t key = *place;
    OutgoingFrame frame = frame_of(key, board_.values().at(key));
    const std::size_t bytes = encoded_bytes(frame.frame);
    if (bytes > room && bytes <= whole) {
      ++place;
      continue;
    }
    waiting_.erase(place);
    keys_[key].waiting = false;
    if (bytes <= room) {
      keys_[key].sent = board_.values().at(key).version;
      return frame;
    }
    ++counts_.telemetry_oversized;
    place = waiting_.begin();
  }
  return std::nullopt;
}

std::optional<OutgoingFrame> TelemetryOutbox::again(const TelemetryTicket& ticket) const {
  const auto value = board_.values().find(ticket.key);
  if (value == board_.values().end() || value->second.version != ticket.version) return {};
  return frame_of(ticket.key, value->second);
}

void TelemetryOutbox::on_acked(const TelemetryTicket& ticket) {
  // What was told lost came through after all, and is still the latest: it need not go again.
  const auto value = board_.values().find(ticket.key);
  if (value == board_.values().end() || value->second.version != ticket.version) return;
  Key& key = keys_[ticket.key];
  if (!key.waiting || key.sent != ticket.version) return;
  key.waiting = false;
  waiting_.erase(std::find(waiting_.begin(), waiting_.end(), ticket.key));
}

void TelemetryOutbox::on_lost(const TelemetryTicket& ticket) {
  const auto key = keys_.find(ticket.key);
  if (key == keys_.end() || key->second.waiting || key->second.sent != ticket.version) return;
  ++counts_.telemetry_repeated;
  wait(ticket.key);
}

void TelemetryOutbox::send_all() {
  for (const auto& [key, value] : board_.values()) wait(key);
}

void TelemetryOutbox::wait(std::uint16_t key) {
  Key& state = keys_[key];
  if (state.waiting) return;
  state.waiting = true;
  waiting_.push_back(key);
}

}  // namespace warren::mesh
