// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/sent_packets.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::uint64_t kPacketThreshold = 3;  // RFC 9002, 6.1.1
constexpr Duration kReorderingMax = milliseconds{300};
constexpr Duration kSilenceMin = milliseconds{80};  // delayed and lost acknowledgements
constexpr Duration kSilenceMax = seconds{2};
constexpr Duration kAlone = milliseconds{100};  // nothing was sent for so long
constexpr Duration kTailTripMax = milliseconds{1500};
constexpr Duration kTailSilenceMin = milliseconds{200};  // one alone is acknowledged late
constexpr Duration kFirstRtt = milliseconds{700};        // before one was measured
constexpr Duration kDecayPeriod = seconds{1};
// To notice that a packet was only late. Where many flows fill a slow cell, that is very late: who
// forgot it would never measure the round trip, and repeat everything for ever.
constexpr Duration kRememberLost = seconds{4};
constexpr Duration kRememberFew = seconds{12};
constexpr std::size_t kFew = 256;                     // packets
constexpr Duration kHeldTooLong = milliseconds{500};  // such a delay is no good for a round trip
// Nobody waits for longer: a round trip above is held for this, whatever the peer says.
constexpr Duration kRttMax = seconds{5};
constexpr Duration kTripMax = seconds{8};  // with its variation
constexpr Duration kPause = milliseconds{400};
constexpr double kSentLossGain = 1.0 / 64.0;

void move_all(std::vector<Ticket>& from, std::vector<Ticket>& to) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
  from.clear();
}

}  // namespace

void SentPackets::on_sent(std::uint64_t number, Packet packet) {
  if (packets_.empty()) first_ = undecided_ = number;
  assert(number == end());
  if (!room()) forget_oldest(packet.sent);
  if (packet.wants_ack) {
    bytes_in_flight_ += packet.ip_bytes;
    ++packets_in_flight_;
    last_asked_ = packet.sent;
  }
  packets_.push_back({.packet = std::move(packet)});
}

// It was sent before what the peer acknowledges, or it acknowledges nothing: too late for a record.
void SentPackets::forget_oldest(MeshTime now) {
  Settled settled;
  if (packets_.front().fate == Fate::kInFlight) lose(packets_.front(), settled);
  if (!settled.lost.empty() && forgotten_.empty()) forgotten_since_ = now;
  move_all(settled.lost, forgotten_);
  packets_.pop_front();
  undecided_ = std::max(undecided_, ++first_);
}

SentPackets::Record* SentPackets::find(std::uint64_t number) {
  return number >= first_ && number < end() ? &packets_[number - first_] : nullptr;
}

SentPackets::Settled SentPackets::on_ack(MeshTime now, const AckFrame& ack) {
  Settled settled;
  if (ack.ranges.empty() || ack.ranges.front().end > end()) return settled;
  const std::uint64_t largest = ack.ranges.front().end - 1;
  if (!largest_acked_ || largest > *largest_acked_) {
    largest_acked_ = largest;
    if (const Record* record = find(largest)) {
      AckReport::Largest news{record->packet.sent, ack.arrived_us, record->packet.ip_bytes, {}};
      news.rtt = rtt_sample(now, record->packet, ack.delay);
      if (news.rtt) measure_rtt(*news.rtt);
      settled.report.largest = news;
    }
  }
  for (auto range = ack.ranges.rbegin(); range != ack.ranges.rend(); ++range) {
    const std::uint64_t from = std::max(range->first, first_);
    for (std::uint64_t number = from; number < range->end; ++number) {
      acknowledge(now, number, settled);
    }
  }
  lose_overtaken(settled);
  forget_settled(now);
  settled.report.pairs = pairs_;
  settled.report.acked_bytes = acked_bytes_;
  settled.report.busy_acked_bytes = busy_acked_bytes_;
  settled.report.loss = loss_;
  settled.report.end = *largest_acked_ + 1;
  return settled;
}

void SentPackets::acknowledge(MeshTime now, std::uint64_t number, Settled& settled) {
  Record& record = *find(number);
  if (record.fate == Fate::kAcked) return;
  if (record.fate == Fate::kLost) {
    // Only late: be more patient with whichever rule was wrong.
    const Duration late = now - record.packet.sent - smoothed_rtt_.value_or(Duration{0});
    if (record.lost_by == LossRule::kOvertaken) {
      reordering_ = std::clamp(late, reordering_, kReorderingMax);
    } else if (record.lost_by == LossRule::kSilence || number == *largest_acked_) {
      Duration& silence = record.lost_by == LossRule::kTail ? tail_silence_ : ack_silence_;
      silence = std::clamp(late * 5 / 4, silence, kSilenceMax);
    }
  } else if (record.packet.wants_ack) {
    bytes_in_flight_ -= record.packet.ip_bytes;
    --packets_in_flight_;
  }
  if (record.packet.wants_ack) measure_loss(false);
  record.fate = Fate::kAcked;
  acked_bytes_ += static_cast<double>(record.packet.ip_bytes);
  if (record.packet.busy) busy_acked_bytes_ += static_cast<double>(record.packet.ip_bytes);
  ++settled.report.newly_acked;
  move_all(record.packet.tickets, settled.acked);
  add_pairs(number);
}

void SentPackets::add_pairs(std::uint64_t number) {
  const auto add = [this](const Record* first, const Record* second) {
    if (first == nullptr || second == nullptr) return;
    if (first->fate != Fate::kAcked || second->fate != Fate::kAcked) return;
    const Duration spacing = second->packet.sent - first->packet.sent;
    if (spacing > AckFrame::kPairGapMax || (spacing > kPause && !second->packet.busy)) {
      ++pairs_.pauses;
      return;
    }
    pairs_.ip_bytes += static_cast<double>(second->packet.ip_bytes);
    pairs_.spacing += spacing;
    pairs_.own += second->packet.own;
    if (!second->packet.busy) return;
    pairs_.busy_pairs += 1.0;
    pairs_.busy_bytes += static_cast<double>(second->packet.ip_bytes);
    pairs_.busy += spacing;
    pairs_.busy_own += second->packet.own;
  };
  const Record* record = find(number);
  if (number > first_) add(find(number - 1), record);
  add(record, find(number + 1));
}

void SentPackets::lose(Record& record, Settled& settled) {
  record.fate = Fate::kLost;
  if (!record.packet.wants_ack) return;
  bytes_in_flight_ -= record.packet.ip_bytes;
  --packets_in_flight_;
  measure_loss(true);
  // Kept too: it may only be late.
  settled.lost.insert(settled.lost.end(), record.packet.tickets.begin(),
                      record.packet.tickets.end());
}

void SentPackets::lose_overtaken(Settled& settled) {
  if (!largest_acked_ || *largest_acked_ < first_) return;
  const Duration by_time = std::max(reordering_, trip());
  for (; undecided_ < *largest_acked_; ++undecided_) {
    Record* record = find(undecided_);
    if (record == nullptr || record->fate != Fate::kInFlight) continue;
    const Duration ahead = find(*largest_acked_)->packet.sent - record->packet.sent;
    const bool overtaken = *largest_acked_ - undecided_ >= kPacketThreshold && ahead >= reordering_;
    if (!overtaken && ahead < by_time) return;
    record->lost_by = LossRule::kOvertaken;
    lose(*record, settled);
  }
}

Duration SentPackets::trip() const {
  if (!smoothed_rtt_) return kFirstRtt;
  return std::min(*smoothed_rtt_ + 4 * rtt_variation_, Duration{kTripMax});
}

// When a packet is held lost though nothing sent later arrived. While more is being sent there is
// no hurry: either the acknowledgements are lost, or one will soon say what arrived.
MeshTime SentPackets::loss_time(const Packet& packet) const {
  if (!smoothed_rtt_) return packet.sent + kFirstRtt;
  const MeshTime alone = packets_.back().packet.sent + kAlone;
  return std::min(std::max(packet.sent + trip() + std::max(ack_silence_, kSilenceMin), alone),
                  packet.sent + trip() + kSilenceMax);
}

// When the oldest packet is held lost because nothing more was sent that could tell. If that is
// wrong, it cost one packet on a link that had nothing to do.
MeshTime SentPackets::tail_time() const {
  return last_asked_ + std::min(trip(), kTailTripMax) + std::max(tail_silence_, kTailSilenceMin);
}

MeshTime SentPackets::loss_time() const {
  for (std::uint64_t number = std::max(undecided_, first_); number < end(); ++number) {
    const Record& record = packets_[number - first_];
    if (record.fate == Fate::kInFlight && record.packet.wants_ack) {
      return std::min({forgotten_since_, loss_time(record.packet), tail_time()});
    }
  }
  return forgotten_since_;
}

SentPackets::Settled SentPackets::on_time(MeshTime now) {
  Settled settled;
  move_all(forgotten_, settled.lost);
  forgotten_since_ = kNever;
  bool tail = tail_time() <= now;
  for (; undecided_ < end(); ++undecided_) {
    Record* record = find(undecided_);
    if (record == nullptr || record->fate != Fate::kInFlight) continue;
    const bool silence = loss_time(record->packet) <= now;
    if (!silence && !tail) break;
    record->lost_by = silence ? LossRule::kSilence : LossRule::kTail;
    if (record->packet.wants_ack) {
      tail = false;
      last_asked_ = now;
    }
    lose(*record, settled);
  }
  forget_settled(now);
  settled.report.pairs = pairs_;
  return settled;
}

std::vector<Ticket> SentPackets::abandon() {
  Settled settled;
  move_all(forgotten_, settled.lost);
  forgotten_since_ = kNever;
  for (; undecided_ < end(); ++undecided_) {
    Record* record = find(undecided_);
    if (record != nullptr && record->fate == Fate::kInFlight) lose(*record, settled);
  }
  return std::move(settled.lost);
}

void SentPackets::forget_path() {
  smoothed_rtt_.reset();
  reordering_ = ack_silence_ = tail_silence_ = Duration{0};
  loss_ = 0.0;
}

// None if the delay told says nothing: too long to be exact, or longer than the packet is away.
std::optional<Duration> SentPackets::rtt_sample(MeshTime now, const Packet& packet,
                                                Duration delay) {
  const Duration away = now - packet.sent;
  if (delay >= kHeldTooLong || delay > away) return {};
  return std::clamp(away - delay, Duration{1}, Duration{kRttMax});
}

void SentPackets::measure_rtt(Duration rtt) {  // RFC 9002, 5.3
  if (!smoothed_rtt_) {
    smoothed_rtt_ = rtt;
    rtt_variation_ = rtt / 2;
    return;
  }
  const Duration difference = *smoothed_rtt_ > rtt ? *smoothed_rtt_ - rtt : rtt - *smoothed_rtt_;
  rtt_variation_ = (3 * rtt_variation_ + difference) / 4;
  *smoothed_rtt_ = (7 * *smoothed_rtt_ + rtt) / 8;
}

void SentPackets::measure_loss(bool lost) { loss_ += ((lost ? 1.0 : 0.0) - loss_) * kSentLossGain; }

void SentPackets::forget_settled(MeshTime now) {
  if (now - last_decay_ > kDecayPeriod) {
    reordering_ = reordering_ * 7 / 8;
    ack_silence_ = ack_silence_ * 15 / 16;
    tail_silence_ = tail_silence_ * 7 / 8;
    last_decay_ = now;
  }
  // One acknowledged record stays, as the first of a pair.
  while (packets_.size() > 1) {
    const Record& record = packets_.front();
    if (record.fate == Fate::kInFlight) return;
    const Duration remember = packets_.size() < kFew ? kRememberFew : kRememberLost;
    const bool lately = record.packet.sent + remember > now && packets_.size() < kPacketsMax / 2;
    const bool starts_a_pair = record.fate == Fate::kAcked && packets_[1].fate != Fate::kAcked;
    if (lately && (record.fate == Fate::kLost || starts_a_pair)) return;
    packets_.pop_front();
    ++first_;
  }
}

std::optional<std::vector<Ticket>> SentPackets::take_repeat(MeshTime sent_before) {
  for (std::uint64_t number = std::max(undecided_, first_); number < end(); ++number) {
    Record& record = packets_[number - first_];
    if (record.packet.sent >= sent_before) return {};
    if (record.fate != Fate::kInFlight || record.repeated || record.packet.tickets.empty()) {
      continue;
    }
    record.repeated = true;
    return record.packet.tickets;
  }
  return {};
}

std::size_t SentPackets::memory_bytes() const {
  std::size_t bytes = packets_.size() * sizeof(Record) + forgotten_.capacity() * sizeof(Ticket);
  for (const Record& record : packets_) bytes += record.packet.tickets.capacity() * sizeof(Ticket);
  return bytes;
}

}  // namespace warren::mesh
