// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/sim_source.hpp"

#include <algorithm>

namespace warren::mesh::sim {

std::optional<MapSource::Packet> SimSource::next_for(MemberId to, MapClass wanted,
                                                     std::size_t limit) {
  if (starved == wanted) return std::nullopt;
  if (limit < packet_bytes_min) ledger_.fail(now_, "asked for too small a map packet");
  auto& left = wanted_[to][static_cast<std::size_t>(wanted)];
  if (left == 0) return std::nullopt;
  const std::size_t bytes =
      std::max<std::size_t>(kStampBytes, std::min<std::uint64_t>(left, limit));
  left -= std::min<std::uint64_t>(left, bytes);
  const std::uint64_t ticket = next_ticket_++;
  under_way_[ticket] = {to, wanted, bytes, false};
  return Packet{ticket, wanted,
                stamped({self_, 0, static_cast<std::uint32_t>(wanted), ticket}, bytes)};
}

std::optional<MapSource::Packet> SimSource::next_for_group(InterfaceIndex, std::size_t limit) {
  if (group_bytes_ == 0) return std::nullopt;
  if (limit < packet_bytes_min) ledger_.fail(now_, "asked for too small a group packet");
  const std::size_t bytes =
      std::max<std::size_t>(kStampBytes, std::min<std::uint64_t>(group_bytes_, limit));
  group_bytes_ -= std::min<std::uint64_t>(group_bytes_, bytes);
  return Packet{
      next_ticket_, MapClass::kFresh,
      stamped({self_, 0, static_cast<std::uint32_t>(MapClass::kFresh), next_ticket_++}, bytes)};
}

void SimSource::on_acknowledged(MemberId to, std::uint64_t ticket) {
  ledger_.on_map_acknowledged(now_, self_, ticket);
  const auto sent = under_way_.find(ticket);
  if (sent == under_way_.end() || sent->second.to != to) return;
  const auto priority = static_cast<std::size_t>(sent->second.priority);
  delivered_[priority] += sent->second.bytes;
  if (sent->second.lost) {  // it was only late: it need not go again
    auto& left = wanted_[to][priority];
    left -= std::min<std::uint64_t>(left, sent->second.bytes);
  }
  under_way_.erase(sent);
}

void SimSource::on_lost(MemberId to, std::uint64_t ticket) {
  const auto sent = under_way_.find(ticket);
  if (sent == under_way_.end() || sent->second.lost) return;
  sent->second.lost = true;
  wanted_[to][static_cast<std::size_t>(sent->second.priority)] += sent->second.bytes;
}

void SimSource::on_restart() {
  for (auto& [ticket, sent] : under_way_) {
    if (!sent.lost) wanted_[sent.to][static_cast<std::size_t>(sent.priority)] += sent.bytes;
  }
  under_way_.clear();
}

std::uint64_t SimSource::open_bytes() const {
  std::uint64_t bytes = 0;
  for (const auto& [to, left] : wanted_) bytes += left[0] + left[1];
  for (const auto& [ticket, sent] : under_way_) bytes += sent.lost ? 0 : sent.bytes;
  return bytes;
}

}  // namespace warren::mesh::sim
