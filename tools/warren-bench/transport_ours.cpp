// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <random>

#include <asio/io_context.hpp>
#include <unistd.h>

#include "tools/warren-bench/transport_payload.hpp"
#include "tools/warren-bench/transport_peer_output.hpp"
#include "tools/warren-bench/transport_peers.hpp"
#include "transport/udp/mesh_runner.hpp"

namespace warren {

using namespace mesh;

namespace {

constexpr MemberId kSender{1};
constexpr MemberId kReceiver{2};
constexpr char kInterface[] = "radio0";

struct Part {
  std::size_t offset = 0;
  std::size_t bytes = 0;
};

// The payload as map packets for the receiver: lost parts first, then new ones.
class PayloadSource : public MapSource {
 public:
  explicit PayloadSource(std::size_t total_bytes) : total_(total_bytes) {}

  std::optional<Packet> next_for(MemberId to, MapClass wanted, std::size_t limit) override {
    if (to != kReceiver || wanted != MapClass::kBacklog || limit <= kPartHeaderBytes) return {};
    const auto part = next_part(limit - kPartHeaderBytes);
    if (!part) return {};
    under_way_[++last_ticket_] = *part;
    return Packet{last_ticket_, wanted, make_payload_part(part->offset, part->bytes)};
  }

  void on_acknowledged(MemberId, std::uint64_t ticket) override {
    under_way_.erase(ticket);
    // It was only late: what waits to be sent again needs no sending.
    std::erase_if(lost_, [&](const Lost& lost) { return lost.ticket == ticket; });
  }

  void on_lost(MemberId, std::uint64_t ticket) override {
    const auto found = under_way_.find(ticket);
    if (found == under_way_.end()) return;
    lost_.push_back({ticket, found->second});
    under_way_.erase(found);
  }

 private:
  struct Lost {
    std::uint64_t ticket = 0;
    Part part;
  };

  std::optional<Part> next_part(std::size_t bytes_max) {
    if (!lost_.empty()) {
      Part& first = lost_.front().part;
      const Part part{first.offset, std::min(first.bytes, bytes_max)};
      first.offset += part.bytes;
      first.bytes -= part.bytes;
      if (first.bytes == 0) lost_.pop_front();
      return part;
    }
    if (next_ == total_) return {};
    const Part part{next_, std::min(bytes_max, total_ - next_)};
    next_ += part.bytes;
    return part;
  }

  std::size_t total_;
  std::size_t next_ = 0;
  std::uint64_t last_ticket_ = 0;
  std::map<std::uint64_t, Part> under_way_;
  std::deque<Lost> lost_;
};

MeshRunner::Config config_of(MemberId self) {
  std::random_device random;
  MeshRunner::Config config;
  config.endpoint.self = self;
  config.endpoint.boot = {(std::uint64_t{random()} << 32) | random()};
  config.endpoint.random_seed = random();
  // The interface's own MTU: no radio needs less here.
  config.endpoint.interfaces = {{}};
  config.sockets.interfaces = {{.name = kInterface}};
  return config;
}

std::shared_ptr<const KeySchedule> keys() { return std::make_shared<PresharedKeys>(Key{1, 2, 3}); }

}  // namespace

void send_by_ours(const TransportPeerOptions& options) {
  asio::io_context io;
  PayloadSource source(options.bytes);
  MeshRunner runner(io, config_of(kSender), keys(), source, [](const MeshEvent&) {});
  print_start();
  runner.start();
  io.run();
  exit_wrong("the sender ended");
}

void receive_by_ours(const TransportPeerOptions& options) {
  asio::io_context io;
  PayloadSource nothing(0);
  PayloadReceived received(options.bytes);
  Progress progress(options.bytes);
  MeshRunner runner(io, config_of(kReceiver), keys(), nothing, [&](const MeshEvent& event) {
    const auto* map = std::get_if<MapArrived>(&event);
    if (map == nullptr) return;
    progress.add(received.take(map->bytes));
    if (progress.is_complete()) io.stop();
  });
  runner.start();
  print_ready();
  io.run();
}

}  // namespace warren
