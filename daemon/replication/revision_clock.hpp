// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "core/layer/claim.hpp"
#include "transport/mesh_time.hpp"

namespace warren::replication {

// When a layer came to its revisions, as this node saw it. Of the past it keeps fewer and fewer, so
// a time may be that of an earlier revision: lags are never told too small.
class RevisionClock {
 public:
  static constexpr std::size_t kMarksMax = 128;

  void note(Revision revision, MeshTime when) {
    if (!marks_.empty() && marks_.back().revision >= revision) return;
    marks_.push_back({revision, when});
    if (marks_.size() <= kMarksMax) return;
    // Every second one of the older half.
    std::deque<Mark> kept;
    for (std::size_t i = 0; i < marks_.size(); ++i) {
      if (i % 2 == 0 || i > kMarksMax / 2) kept.push_back(marks_[i]);
    }
    marks_ = std::move(kept);
  }
  // Since when there has been something after this revision; nothing if there is not.
  std::optional<MeshTime> since(Revision held) const {
    std::optional<MeshTime> since;
    for (auto mark = marks_.rbegin(); mark != marks_.rend() && mark->revision > held; ++mark) {
      since = mark->when;
    }
    return since;
  }

 private:
  struct Mark {
    Revision revision;
    MeshTime when;
  };
  std::deque<Mark> marks_;
};

}  // namespace warren::replication
