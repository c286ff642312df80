// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <csignal>
#include <cstdio>

#include "core/exchange/cloud_reader.hpp"
#include "tools/warren-replay/cli.hpp"
#include "tools/warren-replay/progress.hpp"
#include "tools/warren-replay/scan_reader.hpp"

namespace {

std::atomic<bool> g_stop = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

int fail(const std::string& why) {
  std::fprintf(stderr, "warren-replay: %s\n", why.c_str());
  return 1;
}

tl::expected<std::vector<warren::TimedPose>, std::string> poses_for(
    const warren::ReplayArguments& arguments, const std::vector<std::filesystem::path>& files) {
  if (!arguments.poses) return std::vector<warren::TimedPose>(files.size());
  const auto poses = warren::read_poses(*arguments.poses, arguments.poses_format);
  if (!poses) return tl::unexpected(poses.error());
  return warren::pair_poses(files, *poses);
}

int replay(warren::ReplayArguments arguments) {
  const auto files = warren::list_clouds(arguments.clouds);
  if (!files) return fail(files.error());
  auto poses = poses_for(arguments, *files);
  if (!poses) return fail(poses.error());
  auto client = warren::IngestClient::connect(arguments.socket, "warren-replay");
  if (!client) return fail(client.error());
  if (arguments.options.sensor.empty() && !client->welcome().sensors.empty()) {
    arguments.options.sensor = client->welcome().sensors.front();
  }

  warren::ScanReader reader(*files, std::move(*poses), arguments.gravity_map);
  warren::ProgressView view(stderr);
  warren::Replay replay(
      *client, reader, arguments.options, [&](const warren::ReplaySummary& now) { view.show(now); },
      g_stop);
  const warren::ReplaySummary summary = replay.run();
  view.finish(summary);
  std::fputs((arguments.json ? to_json(summary) : to_text(summary)).c_str(), stdout);
  if (!summary.error.empty()) return fail(summary.error);
  return summary.complete() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const auto line = warren::parse_command_line(argc, argv);
  if (!line.arguments) return line.exit_code;
  std::signal(SIGINT, [](int) { g_stop = true; });
  std::signal(SIGTERM, [](int) { g_stop = true; });
  return replay(*line.arguments);
}
