// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/said.hpp"

#include <algorithm>

namespace warren::replication {

MeshTime Said::due(MeshTime now, const Timers& timers, const Thing& thing) {
  MeshTime due = kNever;
  if (thing.way.hops > way_.hops) {
    if (!worse_since_) worse_since_ = now;
    due = *worse_since_ + timers.worse_way;
  } else {
    worse_since_.reset();
    if (thing.way != way_) due = at_ + timers.between_urgent;
  }
  if (quiet_ && version_ == thing.version) return due;
  const MeshTime quiet =
      std::max(std::max(thing.changed, at_) + timers.quiet, at_ + timers.between);
  return std::min({due, quiet, at_ + timers.refresh});
}

void Said::on_said(MeshTime now, const Thing& thing, bool quiet) {
  ever_ = true;
  at_ = now;
  way_ = thing.way;
  version_ = thing.version;
  quiet_ = quiet;
  worse_since_.reset();
}

}  // namespace warren::replication
