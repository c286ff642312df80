// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/urgent_outbox.hpp"

#include <algorithm>
#include <cassert>

namespace warren::mesh {
namespace {

OutgoingFrame frame_of(std::uint32_t number, std::span<const std::uint8_t> bytes) {
  return {UrgentFrame{number, {bytes.begin(), bytes.end()}}, UrgentTicket{number}};
}

}  // namespace

void UrgentOutbox::send(MeshTime now, std::span<const std::uint8_t> bytes) {
  assert(bytes.size() <= UrgentFrame::kBytesMax);
  drop_stale(now);
  if (messages_.size() == config_.unacknowledged_max) {
    messages_.pop_front();
    ++counts_.urgent_superseded;
  }
  messages_.push_back(
      {next_number_++, now + config_.time_limit, now, 0, {bytes.begin(), bytes.end()}});
}

std::optional<OutgoingFrame> UrgentOutbox::next(MeshTime now, std::size_t room, Duration rtt) {
  drop_stale(now);
  const auto earlier_due = [](const Message& a, const Message& b) { return a.due < b.due; };
  const auto chosen = std::min_element(messages_.begin(), messages_.end(), earlier_due);
  if (chosen == messages_.end() || chosen->due > now) return std::nullopt;
  OutgoingFrame frame = frame_of(chosen->number, chosen->bytes);
  if (encoded_bytes(frame.frame) > room) return std::nullopt;
  ++chosen->copies_sent;
  if (chosen->copies_sent > 1) ++counts_.urgent_copies;
  const bool more_copies = chosen->copies_sent < config_.copies;
  chosen->due = now + (more_copies ? config_.spacing : std::max(rtt, config_.repeat_min));
  return frame;
}

std::optional<OutgoingFrame> UrgentOutbox::again(const UrgentTicket& ticket) const {
  for (const Message& message : messages_) {
    if (message.number == ticket.number) return frame_of(message.number, message.bytes);
  }
  return std::nullopt;
}

MeshTime UrgentOutbox::next_due() const {
  MeshTime due = kNever;
  for (const Message& message : messages_) due = std::min(due, message.due);
  return due;
}

void UrgentOutbox::on_acked(const UrgentTicket& ticket) {
  const auto acked = [&](const Message& message) { return message.number == ticket.number; };
  messages_.erase(std::remove_if(messages_.begin(), messages_.end(), acked), messages_.end());
}

void UrgentOutbox::drop_stale(MeshTime now) {
  while (!messages_.empty() && messages_.front().stale_at <= now) {
    messages_.pop_front();
    ++counts_.urgent_expired;
  }
}

}  // namespace warren::mesh
