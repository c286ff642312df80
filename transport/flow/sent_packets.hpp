// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "transport/flow/ticket.hpp"
#include "transport/mesh_time.hpp"
#include "transport/wire/frames.hpp"

namespace warren::mesh {

// What the acknowledgements of one peer say, in figures; sums run from the first packet on.
struct AckReport {
  // The largest number, if it is news: when it was sent, and by the receiver's clock (modulo 2^32
  // microseconds) when it arrived.
  struct Largest {
    MeshTime sent;
    std::uint32_t arrived_us = 0;
    std::size_t ip_bytes = 0;
    std::optional<Duration> rtt;  // none if the receiver held the acknowledgement for long
  };
  // Over all pairs of consecutive numbers that both arrived, as the AckFrame's sums.
  struct PairSums {
    double ip_bytes = 0.0;  // of the second
    Duration spacing{};     // from one sending to the next
    Duration own{};         // of that, without what went to other peers between
    // Of that, the pairs between which the sender had no rest.
    double busy_pairs = 0.0;
    double busy_bytes = 0.0;
    Duration busy{};
    Duration busy_own{};
    // Pairs that count for nothing because the sender had nothing to send between.
    std::uint64_t pauses = 0;
  };
  std::optional<Largest> largest;
  PairSums pairs;
  double busy_acked_bytes = 0.0;  // of those that the sender had no rest before
  double acked_bytes = 0.0;       // IP bytes, from the first packet on
  double loss = 0.0;              // share of packets, lately
  std::size_t newly_acked = 0;    // packets, late ones included
  std::uint64_t end = 0;          // one more than the largest number acknowledged so far
};

// What was sent to one peer and what became of it. Numbers rise by one with each packet. Loss is
// found by later packets that arrived (RFC 9002, 6.1, with a reordering allowance that adapts), and
// at the tail by time, without back-off: while nothing more is sent, one packet in a round trip,
// and what becomes of it tells of the others (as RFC 8985, 7). Bounded: at most kPacketsMax
// records; one more makes the oldest forgotten, as lost if it is in flight.
class SentPackets {
 public:
  static constexpr std::size_t kPacketsMax = 16384;

  struct Packet {
    MeshTime sent;
    std::size_t ip_bytes = 0;
    Duration own{};     // time since the packet before, without what went to other peers
    bool busy = false;  // the sender had no rest since the packet before
    bool wants_ack = false;
    std::vector<Ticket> tickets;
  };
  struct Settled {
    std::vector<Ticket> acked;  // late ones, told lost before, included
    std::vector<Ticket> lost;
    AckReport report;
  };

  // Precondition: number is one more than the last (any at first).
  void on_sent(std::uint64_t number, Packet packet);
  Settled on_ack(MeshTime now, const AckFrame& ack);
  // All that is in flight is lost: the peer is no more.
  std::vector<Ticket> abandon();
  // The path is another: round trip and loss begin anew.
  void forget_path();
  // Packets lost by time.
  Settled on_time(MeshTime now);
  // When on_time() may find one.
  MeshTime loss_time() const;

  bool room() const { return packets_.size() < kPacketsMax; }
  std::size_t bytes_in_flight() const { return bytes_in_flight_; }
  std::size_t packets_in_flight() const { return packets_in_flight_; }

  std::optional<Duration> smoothed_rtt() const { return smoothed_rtt_; }
  // Share of packets lost lately.
  double loss() const { return loss_; }

  // The oldest in flight, sent before the time given, that was not repeated yet: it is now.
  std::optional<std::vector<Ticket>> take_repeat(MeshTime sent_before);

  std::size_t memory_bytes() const;

 private:
  enum class Fate : std::uint8_t { kInFlight, kAcked, kLost };
  enum class LossRule : std::uint8_t { kOvertaken, kSilence, kTail };
  struct Record {
    Packet packet;
    Fate fate = Fate::kInFlight;
    LossRule lost_by = LossRule::kSilence;
    bool repeated = false;
  };

  std::uint64_t end() const { return first_ + packets_.size(); }
  Record* find(std::uint64_t number);
  void acknowledge(MeshTime now, std::uint64_t number, Settled& settled);
  void lose(Record& record, Settled& settled);
  void forget_oldest(MeshTime now);
  void lose_overtaken(Settled& settled);
  void add_pairs(std::uint64_t number);
  std::optional<Duration> rtt_sample(MeshTime now, const Packet& packet, Duration delay);
  void measure_rtt(Duration rtt);
  void measure_loss(bool lost);
  void forget_settled(MeshTime now);
  Duration trip() const;
  MeshTime loss_time(const Packet& packet) const;
  MeshTime tail_time() const;

  std::deque<Record> packets_;  // numbers first_ to end() - 1
  std::uint64_t first_ = 0;
  std::uint64_t undecided_ = 0;  // none before this is in flight
  std::optional<std::uint64_t> largest_acked_;
  std::size_t bytes_in_flight_ = 0;
  std::size_t packets_in_flight_ = 0;
  std::vector<Ticket> forgotten_;  // lost with their record, not told yet
  MeshTime forgotten_since_ = kNever;
  AckReport::PairSums pairs_;
  double acked_bytes_ = 0.0;
  double busy_acked_bytes_ = 0.0;

  std::optional<Duration> smoothed_rtt_;
  Duration rtt_variation_{};
  Duration reordering_{};    // how much later than its successors a packet may come
  Duration ack_silence_{};   // how long acknowledgements may stay away while packets are in flight
  Duration tail_silence_{};  // the same while nothing more is sent
  MeshTime last_decay_{};
  MeshTime last_asked_{};  // a packet that wants an acknowledgement went, or was held lost as tail
  double loss_ = 0.0;
};

}  // namespace warren::mesh
