// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "tests/transport/delivery/toy_node.hpp"

namespace warren::mesh::test {

struct ChannelFaults {
  double loss = 0.0;
  double duplicate = 0.0;
  Duration delay_max = std::chrono::milliseconds(20);  // each packet its own: they overtake
  bool cut = false;
};

// Two nodes, packets between them, and what the endpoint would do: acknowledge packets, call them
// lost after a while, refuse packets for an earlier life, notice restarts.
class ToyPair {
 public:
  ToyPair(const DeliveryConfig& config, std::uint64_t seed) : ToyPair(config, config, seed) {}
  ToyPair(const DeliveryConfig& first, const DeliveryConfig& second, std::uint64_t seed);

  ChannelFaults faults;
  std::size_t room = 1200;
  std::size_t packets_per_step = 2;

  static constexpr Duration kStep = std::chrono::milliseconds(5);
  void step();
  void restart(std::size_t index);

  ToyNode& node(std::size_t index) { return nodes_.at(index); }
  MeshTime now() const { return now_; }
  Random& random() { return random_; }
  std::uint64_t packets_sent() const { return packets_sent_; }

 private:
  struct Packet {
    std::size_t from = 0;
    std::uint64_t from_life = 0;
    std::uint64_t to_life = 0;
    std::uint64_t number = 0;
    std::vector<Frame> frames;
  };
  struct Sent {
    std::size_t from = 0;
    std::uint64_t from_life = 0;
    std::uint64_t to_life = 0;
    MeshTime lost_at;
    bool told_lost = false;
    std::vector<Ticket> tickets;
  };
  void send(std::size_t from);
  void carry(Packet packet);
  void deliver(Packet packet);
  void on_ack(std::uint64_t number);
  void tell_lost();
  Duration some_delay();

  MeshTime now_{std::chrono::seconds(1)};
  Random random_;
  std::array<ToyNode, 2> nodes_;
  std::array<std::uint64_t, 2> known_life_{1, 1};  // of node i, as the other knows it
  std::array<MeshTime, 2> known_at_{kNever, kNever};
  std::multimap<MeshTime, Packet> in_flight_;
  std::multimap<MeshTime, std::uint64_t> acks_;
  std::map<std::uint64_t, Sent> sent_;
  std::uint64_t packets_sent_ = 0;
};

}  // namespace warren::mesh::test
