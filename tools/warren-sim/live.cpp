// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-sim/live.hpp"

#include <algorithm>
#include <mutex>
#include <thread>

namespace warren::world {
namespace {

// A robot's sweeps as scans, cast when they are asked for.
class SimulatedScans : public ScanSource {
 public:
  SimulatedScans(const Simulation& simulation, std::size_t robot) : frames_(simulation, robot) {}

  std::size_t count() const override { return frames_.count(); }
  tl::expected<std::optional<TimedScan>, std::string> next() override {
    auto frame = frames_.next();
    if (!frame) return std::nullopt;
    TimedScan timed;
    timed.time_s = frame->time_s;
    timed.scan.T_map_base = warren::Pose::of(frame->T_map_base);
    timed.scan.T_base_sensor = warren::Pose::of(frame->T_base_sensor);
    if (frame->gravity_map) timed.scan.gravity_map = *frame->gravity_map;
    timed.scan.points_sensor = std::move(frame->points_sensor);
    return timed;
  }

 private:
  FrameStream frames_;
};

// What all robots have done, summed up from any of their threads.
class TeamSummary {
 public:
  TeamSummary(std::size_t robots, const Replay::Progress& progress)
      : parts_(robots), progress_(progress) {}

  void update(std::size_t robot, const ReplaySummary& summary) {
    const std::lock_guard lock(mutex_);
    parts_[robot] = summary;
    progress_(sum());
  }
  ReplaySummary sum() const {
    ReplaySummary sum;
    for (const ReplaySummary& part : parts_) {
      sum.scans += part.scans;
      sum.sent += part.sent;
      sum.taken += part.taken;
      sum.dropped_overload += part.dropped_overload;
      sum.dropped_out_of_order += part.dropped_out_of_order;
      sum.rejected += part.rejected;
      sum.points += part.points;
      sum.wall_s = std::max(sum.wall_s, part.wall_s);
      if (sum.last_reason.empty()) sum.last_reason = part.last_reason;
      if (sum.error.empty()) sum.error = part.error;
    }
    return sum;
  }

 private:
  std::mutex mutex_;
  std::vector<ReplaySummary> parts_;
  const Replay::Progress& progress_;
};

using Clients = std::vector<IngestClient>;

tl::expected<Clients, std::string> connect_all(const LiveOptions& options) {
  Clients clients;
  for (const std::string& socket : options.sockets) {
    auto client = IngestClient::connect(socket, "warren-sim");
    if (!client) return tl::unexpected(client.error());
    clients.push_back(std::move(*client));
  }
  return clients;
}

ReplayOptions replay_options(const LiveOptions& options, const IngestClient& client,
                             const LidarModel& lidar) {
  ReplayOptions replay;
  replay.sensor = options.sensor;
  if (replay.sensor.empty() && !client.welcome().sensors.empty()) {
    replay.sensor = client.welcome().sensors.front();
  }
  replay.frame_epoch = options.frame_epoch;
  replay.rate_hz.reset();
  if (options.real_time) replay.rate_hz = lidar.rate_hz;
  return replay;
}

}  // namespace

tl::expected<ReplaySummary, std::string> run_live(const Simulation& simulation,
                                                  const LiveOptions& options,
                                                  const Replay::Progress& progress,
                                                  const std::atomic<bool>& stop) {
  const auto& robots = simulation.spec().robots;
  if (options.sockets.size() != robots.size()) {
    return tl::unexpected("one --socket per robot is needed: " + std::to_string(robots.size()));
  }
  auto clients = connect_all(options);
  if (!clients) return tl::unexpected(clients.error());
  TeamSummary team(robots.size(), progress);
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      threads.emplace_back([&, i, &client = (*clients)[i]] {
        SimulatedScans scans(simulation, i);
        Replay replay(
            client, scans, replay_options(options, client, robots[i].lidar),
            [&](const ReplaySummary& now) { team.update(i, now); }, stop);
        team.update(i, replay.run());
      });
    }
  }
  return team.sum();
}

}  // namespace warren::world
