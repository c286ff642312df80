// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/session_keys.hpp"

#include <algorithm>

namespace warren::mesh {
namespace {

constexpr std::uint64_t kBeaconsOvertaken = 8;

}  // namespace

SessionKeys::SessionKeys(const KeySchedule& keys, BootId self, BootId peer,
                         std::uint64_t first_number)
    : self_(self),
      peer_(peer),
      sealing_(keys.pair_key(self, peer)),
      opening_(keys.pair_key(peer, self)),
      group_(keys.group_key(peer)),
      first_number_(first_number),
      next_number_(first_number) {}

std::vector<std::uint8_t> SessionKeys::seal(std::span<const std::uint8_t> content) {
  return mesh::seal(sealing_, {PacketType::kPair, self_, next_number_++}, content);
}

tl::expected<SessionKeys::Content, Unused> SessionKeys::open(const PacketHeader& header,
                                                             std::span<const std::uint8_t> packet) {
  const bool pair = header.type == PacketType::kPair;
  ReplayWindow& window = pair                                 ? pair_window_
                         : header.type == PacketType::kBeacon ? beacon_window_
                                                              : group_window_;
  const bool beacon = header.type == PacketType::kBeacon;
  if (!window.is_new(header.number) ||
      (beacon && header.number + kBeaconsOvertaken < newest_beacon_end_)) {
    return tl::unexpected(Unused::kReplayed);
  }
  auto content = mesh::open(pair ? opening_ : group_, packet);
  if (!content) return tl::unexpected(Unused::kNotAuthentic);
  window.mark(header.number);
  if (beacon) newest_beacon_end_ = std::max(newest_beacon_end_, header.number + 1);
  if (pair) newest_pair_end_ = std::max(newest_pair_end_, header.number + 1);
  return *std::move(content);
}

}  // namespace warren::mesh
