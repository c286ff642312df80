// SPDX-License-Identifier: Apache-2.0
#include "transfer.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace warren::mesh {
namespace {

constexpr std::size_t kAckPacketBytes = 28 + 32 + 20;
constexpr Duration kLookAgain{100};
constexpr std::size_t kRangeBytes = 4;

}  // namespace

Transfer::Transfer(const TransferConfig& config)
    : config_(config),
      there_(config.there, config.seed * 2 + 1),
      back_(config.back, config.seed * 2 + 2) {
  for (const TransferConfig::Load& load : config.flows) {
    Side side;
    side.load = load;
    side.bytes_left = load.app_bytes > 0 ? load.app_bytes : std::size_t{1} << 60;
    side.sender = std::make_unique<Flow>(RateController::Config{});
    side.receiver = std::make_unique<Flow>(RateController::Config{});
    sides_.push_back(std::move(side));
  }
}

void Transfer::run() {
  const auto over = [this] {
    return std::all_of(sides_.begin(), sides_.end(),
                       [](const Side& side) { return side.finished.has_value(); });
  };
  while (!over() && now_ < MeshTime{config_.until}) step();
}

void Transfer::run_until(Duration until) {
  while (now_ < MeshTime{until}) step();
}

void Transfer::step() {
  now_ = std::max(now_, std::min(next_event(), now_ + std::chrono::milliseconds{20}));
  while (there_.next_arrival() <= now_) arrive_there(there_.take_arrival());
  while (back_.next_arrival() <= now_) arrive_back(back_.take_arrival());
  for (std::size_t flow = 0; flow < sides_.size(); ++flow) {
    settle(sides_[flow], sides_[flow].sender->on_time(now_));
    send_acks(flow);
    if (started(sides_[flow])) send_data(flow);
  }
}

MeshTime Transfer::next_event() const {
  MeshTime next = std::min(there_.next_arrival(), back_.next_arrival());
  for (const Side& side : sides_) {
    next = std::min({next, side.sender->next_time(), side.receiver->next_time()});
    if (!started(side)) next = std::min(next, MeshTime{side.load.start});
    if (may_offer(side)) next = std::min(next, std::max(side.pacer.ready_at(), now_ + kLookAgain));
  }
  return std::max(next, now_ + Duration{1});
}

std::size_t Transfer::available(const Side& side) const {
  const MeshTime slow_from{side.load.start + side.load.slow_from};
  if (side.load.app_bit_s <= 0.0 || now_ < slow_from) return side.bytes_left;
  const double seconds = static_cast<double>((now_ - slow_from).count()) * 1e-6;
  const double ready = seconds * side.load.app_bit_s / 8.0 - side.bytes_offered;
  return std::min(side.bytes_left, static_cast<std::size_t>(std::max(ready, 0.0)));
}

bool Transfer::may_offer(const Side& side) const {
  return started(side) && side.sender->may_send(now_) &&
         (!side.resend.empty() || available(side) > 0 || !side.under_way.empty());
}

void Transfer::send_data(std::size_t flow) {
  Side& side = sides_[flow];
  while (side.sender->may_send(now_)) {
    side.pacer.want(0, true);
    if (!side.pacer.next(now_)) return;
    if (!send_one(flow, side)) return;
  }
}

bool Transfer::send_one(std::size_t flow, Side& side) {
  while (!side.resend.empty()) {
    const std::uint64_t chunk = side.resend.front();
    side.resend.pop_front();
    const auto found = side.under_way.find(chunk);
    if (found == side.under_way.end()) continue;
    transmit(flow, side, chunk, found->second, false);
    return true;
  }
  const std::size_t room = side.sender->packet_bytes() - kOverhead;
  const std::size_t ready = available(side);
  if (side.load.app_bit_s > 0.0 ? ready >= room : ready > 0) {
    const std::size_t bytes = std::min(ready, room);
    side.bytes_left -= bytes;
    if (now_ >= MeshTime{side.load.start + side.load.slow_from}) {
      side.bytes_offered += static_cast<double>(bytes);
    }
    side.under_way.emplace(side.next_chunk, bytes);
    side.arrived.push_back(false);
    transmit(flow, side, side.next_chunk++, bytes, false);
    return true;
  }
  const auto repeat = side.sender->take_repeat(now_);
  if (!repeat) return false;
  const std::uint64_t chunk = std::get<MapTicket>(repeat->front()).number;
  const auto found = side.under_way.find(chunk);
  if (found != side.under_way.end()) transmit(flow, side, chunk, found->second, true);
  return true;
}

void Transfer::transmit(std::size_t flow, Side& side, std::uint64_t chunk, std::size_t bytes,
                        bool repeat) {
  const std::size_t ip_bytes = bytes + kOverhead;
  if (side.arrived[chunk]) ++side.resent_in_vain;
  const bool backlogged = side.pacer.on_sent(now_, 0, ip_bytes, side.sender->pace());
  Flow::Sent sent{.number = side.next_number++,
                  .ip_bytes = ip_bytes,
                  .wants_ack = true,
                  .backlogged = backlogged,
                  .repeat = repeat,
                  .tickets = {MapTicket{chunk, MapClass::kBacklog}}};
  contents_[next_id_] = {sent.number, chunk, bytes, there_.queue(now_)};
  there_.send(now_, {flow, ip_bytes, next_id_++});
  side.sender->on_sent(now_, std::move(sent));
  side.bytes_sent += ip_bytes;
}

void Transfer::send_acks(std::size_t flow) {
  Side& side = sides_[flow];
  while (side.receiver->ack_due(now_)) {
    auto ack = side.receiver->take_ack(now_);
    if (!ack) return;
    ack->arrived_us += clock_difference();
    const std::size_t bytes = kAckPacketBytes + kRangeBytes * ack->ranges.size();
    ack_bytes_ += bytes;
    acks_[next_id_] = std::move(*ack);
    back_.send(now_, {flow, bytes, next_id_++});
  }
}

void Transfer::settle(Side& side, const Flow::Outcome& outcome) {
  for (const Ticket& ticket : outcome.acked) {
    side.under_way.erase(std::get<MapTicket>(ticket).number);
  }
  for (const Ticket& ticket : outcome.lost) {
    side.resend.push_back(std::get<MapTicket>(ticket).number);
  }
}

void Transfer::arrive_there(const BottleneckPacket& packet) {
  Side& side = sides_[packet.flow];
  const Content content = contents_[packet.id];
  contents_.erase(packet.id);
  side.receiver->on_received(now_, {content.number, packet.ip_bytes, true});
  side.arrivals.push_back(now_);
  waited_.push_back({now_, content.queue});
  if (side.arrived[content.chunk]) return;
  side.arrived[content.chunk] = true;
  side.bytes_arrived += content.app_bytes;
  if (side.bytes_arrived == side.load.app_bytes) side.finished = now_;
}

void Transfer::arrive_back(const BottleneckPacket& packet) {
  const AckFrame ack = std::move(acks_[packet.id]);
  acks_.erase(packet.id);
  settle(sides_[packet.flow], sides_[packet.flow].sender->on_ack(now_, ack));
}

std::uint32_t Transfer::clock_difference() const {
  const Duration at = now_.time_since_epoch();
  auto difference =
      static_cast<std::int64_t>(static_cast<double>(at.count()) * config_.clock_drift);
  difference += 123'456'789'012;
  for (const auto& [from, step] : config_.clock_steps) {
    if (at >= from) difference += step.count();
  }
  return static_cast<std::uint32_t>(difference);
}

std::optional<MeshTime> Transfer::first_arrival_after(Duration time, std::size_t flow) const {
  const auto& arrivals = sides_[flow].arrivals;
  const auto found = std::lower_bound(arrivals.begin(), arrivals.end(), MeshTime{time});
  if (found == arrivals.end()) return {};
  return *found;
}

}  // namespace warren::mesh
