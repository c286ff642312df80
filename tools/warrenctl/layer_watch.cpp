// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/layer_watch.hpp"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <optional>
#include <thread>
#include <vector>

#include "tools/rivals/octree7.hpp"
#include "tools/warrenctl/ask.hpp"
#include "tools/warrenctl/layer_follower.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

// The predecessor sent a diff every ten seconds; oftener would only cost it more.
constexpr int kPredecessorTick_s = 10;

struct Traffic {
  int seconds = 0;
  std::uint64_t ours_bytes = 0;
  std::uint64_t predecessor_bytes = 0;

  Traffic& operator+=(const Traffic& other) {
    seconds += other.seconds;
    ours_bytes += other.ours_bytes;
    predecessor_bytes += other.predecessor_bytes;
    return *this;
  }
};

// The same layer, one predecessor's tick behind: what its next diff is made against.
class PredecessorDiffs {
 public:
  std::uint64_t bytes_of_next(LayerFollower& follower) {
    const Replica* const now = follower.copy();
    if (now == nullptr) return 0;
    if (!published_ || published_->id() != now->id()) {
      published_.emplace(now->id(), now->resolution());
    }
    std::vector<CodedBlock> changed;
    for (const BlockOrdinal block : follower.take_changed()) {
      changed.push_back({block, now->codes(block)});
    }
    const auto voxels = changed_voxels(changed, *published_);
    published_->publish(changed);
    return voxels.empty() ? 0 : encode_octree7(voxels, Pruning::kNone).size();
  }

 private:
  std::optional<Replica> published_;
};

void print_rates(const std::string& what, const Traffic& traffic) {
  const auto rate = [&](std::uint64_t bytes) {
    return static_cast<double>(bytes) / (1e3 * std::max(traffic.seconds, 1));
  };
  std::cout << std::fixed << std::setprecision(2) << what << "diff-maps "
            << rate(traffic.ours_bytes) << " kB/s, the predecessor's encoding "
            << rate(traffic.predecessor_bytes) << " kB/s";
  if (traffic.ours_bytes > 0) {
    std::cout << std::setprecision(1) << " ("
              << static_cast<double>(traffic.predecessor_bytes) /
                     static_cast<double>(traffic.ours_bytes)
              << " times)";
  }
  std::cout << std::endl;  // is watched live
}

}  // namespace

int run(const LayerWatchCommand& command, const std::string& socket) {
  LayerFollower follower([&](const auto& request) { return ask_daemon(socket, request); });
  PredecessorDiffs predecessor;
  Traffic total;
  Traffic recent;
  while (total.seconds + recent.seconds < command.seconds) {
    const auto taken = follower.catch_up();
    // Before the first scan, and after the daemon has gone, there is no layer.
    if (!taken && follower.copy() != nullptr) break;
    recent.ours_bytes += taken.value_or(0);
    ++recent.seconds;
    if (recent.seconds % kPredecessorTick_s == 0) {
      recent.predecessor_bytes = predecessor.bytes_of_next(follower);
      total += recent;
      print_rates("   after " + std::to_string(total.seconds) + " s: ", recent);
      recent = {};
    }
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  recent.predecessor_bytes = predecessor.bytes_of_next(follower);
  total += recent;
  print_rates("in all " + std::to_string(total.seconds) + " s: ", total);
  return follower.copy() != nullptr ? 0 : 1;
}

}  // namespace warren
