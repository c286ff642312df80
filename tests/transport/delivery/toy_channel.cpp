// SPDX-License-Identifier: Apache-2.0
#include "tests/transport/delivery/toy_channel.hpp"

#include <cstdlib>
#include <iterator>
#include <utility>

namespace warren::mesh::test {

ToyPair::ToyPair(const DeliveryConfig& first, const DeliveryConfig& second, std::uint64_t seed)
    : random_(seed), nodes_{ToyNode(first, seed + 1), ToyNode(second, seed + 2)} {}

void ToyPair::step() {
  now_ += kStep;
  for (std::size_t i = 0; i < 2; ++i) {
    if (known_at_[i] > now_) continue;
    known_at_[i] = kNever;
    known_life_[i] = nodes_[i].life();
    nodes_[1 - i].on_peer_restarted();
  }
  while (!in_flight_.empty() && in_flight_.begin()->first <= now_)
    deliver(std::move(in_flight_.extract(in_flight_.begin()).mapped()));
  while (!acks_.empty() && acks_.begin()->first <= now_)
    on_ack(acks_.extract(acks_.begin()).mapped());
  tell_lost();
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t packet = 0; packet < packets_per_step; ++packet) send(i);
  }
}

void ToyPair::restart(std::size_t index) {
  nodes_[index].restart();
  known_at_[index] = now_ + some_delay();
}

void ToyPair::send(std::size_t from) {
  ToyNode& node = nodes_[from];
  FilledPacket filled = node.fill(now_, room);
  if (filled.frames.empty()) return;
  const std::uint64_t number = packets_sent_++;
  const std::uint64_t to_life = known_life_[1 - from];
  sent_[number] = {from,    node.life(),
                   to_life, now_ + std::chrono::milliseconds(60),
                   false,   std::move(filled.tickets)};
  // Through the wire format and back.
  std::vector<std::uint8_t> content;
  for (const Frame& frame : filled.frames) append(content, frame);
  auto frames = read_frames(content);
  if (!frames) std::abort();
  const Packet packet{from, node.life(), to_life, number, std::move(*frames)};
  if (chance(random_, faults.duplicate)) carry(packet);
  carry(packet);
}

void ToyPair::carry(Packet packet) {
  if (faults.cut || chance(random_, faults.loss)) return;
  in_flight_.emplace(now_ + some_delay(), std::move(packet));
}

void ToyPair::deliver(Packet packet) {
  ToyNode& receiver = nodes_[1 - packet.from];
  if (packet.to_life != receiver.life()) return;
  // The receiver opens no packets of a life that it does not know yet, or not any more.
  if (packet.from_life != known_life_[packet.from]) return;
  receiver.on_frames(now_, std::move(packet.frames));
  if (!faults.cut && !chance(random_, faults.loss))
    acks_.emplace(now_ + some_delay(), packet.number);
}

void ToyPair::on_ack(std::uint64_t number) {
  const auto sent = sent_.find(number);
  if (sent == sent_.end()) return;
  ToyNode& node = nodes_[sent->second.from];
  const bool same_lives = sent->second.from_life == node.life() &&
                          sent->second.to_life == known_life_[1 - sent->second.from];
  if (same_lives) {
    for (const Ticket& ticket : sent->second.tickets) node.outbox().on_acked(now_, ticket);
  }
  sent_.erase(sent);
}

// What was told lost may still turn out to have arrived, for half a second.
void ToyPair::tell_lost() {
  for (auto sent = sent_.begin(); sent != sent_.end();) {
    Sent& packet = sent->second;
    if (!packet.told_lost && packet.lost_at <= now_) {
      packet.told_lost = true;
      ToyNode& node = nodes_[packet.from];
      for (const Ticket& ticket : packet.tickets) {
        if (packet.from_life != node.life()) break;
        node.outbox().on_lost(now_, ticket);
        node.inbox().on_lost(ticket);
      }
    }
    const bool forgotten = packet.lost_at + std::chrono::milliseconds(500) <= now_;
    sent = forgotten ? sent_.erase(sent) : std::next(sent);
  }
}

Duration ToyPair::some_delay() {
  const auto most = static_cast<std::uint64_t>(faults.delay_max.count());
  return Duration(static_cast<Duration::rep>(below(random_, most) + 1));
}

}  // namespace warren::mesh::test
