// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/peers_bench.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <numeric>

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>

#include "daemon/fleet_setup.hpp"
#include "daemon/log.hpp"
#include "tools/warren-bench/cpu_clock.hpp"
#include "tools/warren-bench/light_peer.hpp"
#include "transport/udp/address_text.hpp"

namespace warren {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::duration;

constexpr double kMeetWithin_s = 60.0;
constexpr auto kBetweenLooks = std::chrono::milliseconds(50);

Clock::duration time_of(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(duration<double>(seconds));
}

double seconds_since(Clock::time_point start) {
  return duration<double>(Clock::now() - start).count();
}

void tell(const char* line) {
  std::fprintf(stderr, "%s\n", line);
  std::fflush(stderr);
}

// As a daemon's config, so that the peers are what a daemon would be by it.
tl::expected<FleetConfig, std::string> config_of(const PeersOptions& options, std::size_t robot) {
  Config config;
  config.node.name = "light-" + std::to_string(robot);
  config.layer.tick_s = options.tape.tick_s;
  config.map.resolution_m = options.tape.resolution_m;
  config.share.policy = SharePolicyChoice::kNothing;
  config.mesh.key_file = options.key_file;
  // The group is nobody else's: they are not to hear each other.
  config.mesh.port = options.port_base + 2 * static_cast<std::uint32_t>(robot);
  config.mesh.group_port = config.mesh.port + 1;
  MeshInterfaceConfig& interface = config.mesh.interfaces.emplace_back();
  interface.name = options.interface;
  for (const std::string& base : options.bases) {
    const auto address = mesh::parse_mesh_address(base);
    if (!address) return tl::unexpected(base + " is no ADDRESS:PORT");
    interface.seeds.push_back(*address);
  }
  return fleet_config_of(config);
}

class Peers {
 public:
  explicit Peers(const PeersOptions& options) : options_(options) {}
  ~Peers() {
    for (const auto& peer : peers_) peer->stop();
  }

  tl::expected<void, std::string> make(const FleetTape& tape) {
    for (std::size_t i = 0; i < options_.robots; ++i) {
      const auto config = config_of(options_, i);
      if (!config) return tl::unexpected(config.error());
      const TapePlay play(tape, i * tape.ticks.size() / options_.robots);
      if (play.ticks_max() < ticks_each()) {
        return tl::unexpected(std::string("the tape is too short for so many seconds"));
      }
      peers_.push_back(std::make_unique<LightPeer>(io_, *config, play));
    }
    for (const auto& peer : peers_) peer->start();
    return {};
  }

  bool meet_bases() {
    return run_until(kMeetWithin_s,
                     [&](const LightPeer::Progress& peer) {
                       return peer.neighbours_up >= options_.bases.size();
                     })
        .has_value();
  }

  // Robots tick as often as each other, but not at once.
  void play(PeersResult& result) {
    const std::uint64_t sent_before = bytes_sent();
    const double cpu_before = thread_cpu_s();
    const auto start = Clock::now();
    const auto robots = static_cast<double>(peers_.size());
    result.ticks = ticks_each() * peers_.size();
    for (std::uint64_t i = 0; i < result.ticks; ++i) {
      const double due_s = static_cast<double>(i) / robots * options_.tape.tick_s;
      io_.run_until(start + time_of(due_s));
      result.ticks_late += seconds_since(start) > due_s + options_.tape.tick_s;
      peers_[i % peers_.size()]->tick();
    }
    io_.run_until(start + time_of(options_.seconds));
    result.seconds = seconds_since(start);
    result.cores = (thread_cpu_s() - cpu_before) / result.seconds;
    result.bytes_sent = bytes_sent() - sent_before;
  }

  void settle(PeersResult& result) {
    const auto has_all = [&](const LightPeer::Progress& peer) {
      return peer.have_all >= options_.bases.size();
    };
    const auto is_equal = [&](const LightPeer::Progress& peer) {
      return peer.digests_equal >= options_.bases.size();
    };
    for (const auto& peer : peers_) peer->flush();
    result.caught_up_after_s = run_until(options_.settle_s, has_all);
    // They are told once a layer has been quiet for a while.
    (void)run_until(options_.settle_s, is_equal);
    for (const auto& peer : peers_) {
      result.digests_equal += is_equal(peer->progress());
      result.voxels += peer->voxels_published();
    }
  }

 private:
  std::size_t ticks_each() const {
    return static_cast<std::size_t>(
        std::max(1.0, std::round(options_.seconds / options_.tape.tick_s)));
  }

  std::uint64_t bytes_sent() const {
    return std::transform_reduce(peers_.begin(), peers_.end(), std::uint64_t{0}, std::plus<>{},
                                 [](const auto& peer) { return peer->bytes_sent(); });
  }

  // Seconds until this was so of all of them; nothing if it was not in time.
  template <typename Condition>
  std::optional<double> run_until(double limit_s, Condition&& condition) {
    const auto start = Clock::now();
    const auto holds = [&](const auto& peer) { return condition(peer->progress()); };
    while (!std::all_of(peers_.begin(), peers_.end(), holds)) {
      if (seconds_since(start) > limit_s) return std::nullopt;
      io_.run_for(kBetweenLooks);
    }
    return seconds_since(start);
  }

  const PeersOptions& options_;
  asio::io_context io_;
  asio::executor_work_guard<asio::io_context::executor_type> working_ = asio::make_work_guard(io_);
  std::vector<std::unique_ptr<LightPeer>> peers_;
};

}  // namespace

tl::expected<PeersResult, std::string> bench_peers(const PeersOptions& options) {
  start_log(LogLevel::kWarning, LogFormat::kText);
  const auto tape = record_fleet_tape(options.tape);
  if (!tape) return tl::unexpected(tape.error());
  Peers peers(options);
  if (const auto made = peers.make(*tape); !made) return tl::unexpected(made.error());
  if (!peers.meet_bases()) return tl::unexpected(std::string("not all met all of the bases"));
  PeersResult result;
  tell("ready");
  peers.play(result);
  tell("published");
  peers.settle(result);
  return result;
}

}  // namespace warren
