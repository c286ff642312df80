// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/replication/announcement.hpp"
#include "daemon/replication/config.hpp"

namespace warren::replication {

// The way by which something comes here.
struct Way {
  Hops hops = kNoWay;
  std::optional<MemberId> provider;
  friend bool operator==(const Way&, const Way&) = default;
};

// When one thing that is held has to be announced again. At once: a better way to it. After a
// while: a worse one. What is held, when it has been quiet; while it goes on changing, now and
// then: providers know what they delivered without being told.
class Said {
 public:
  struct Thing {
    Way way;
    std::uint64_t version = 0;           // counts its changes
    MeshTime changed = MeshTime::min();  // the last of them
  };

  bool ever() const { return ever_; }
  MeshTime at() const { return at_; }
  // Precondition: ever().
  MeshTime due(MeshTime now, const Timers& timers, const Thing& thing);
  // Quiet: there is nothing more to say until it changes.
  void on_said(MeshTime now, const Thing& thing, bool quiet);

 private:
  bool ever_ = false;
  MeshTime at_{};
  Way way_;
  std::uint64_t version_ = 0;
  bool quiet_ = false;
  std::optional<MeshTime> worse_since_;
};

}  // namespace warren::replication
