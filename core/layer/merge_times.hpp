// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>

#include "core/layer/claim.hpp"

namespace warren {

// Fleet times of a layer's revisions, at most kTimesMax of them: past that only every second is
// kept, then every fourth, and so on. What is kept does not depend on the order of notes.
class MergeTimes {
 public:
  static constexpr std::size_t kTimesMax = 256;
  static constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::min();

  // Returns the revision after which times may now be other than before.
  Revision note(Revision revision, std::int64_t fleet_time_ns);
  // Of the first revision kept that is not before this one, or of the latest noted.
  std::int64_t time_ns(Revision revision) const;
  std::size_t size() const { return times_.size(); }

 private:
  bool keeps(Revision revision) const { return revision.number % stride_ == 0; }

  std::map<Revision, std::int64_t> times_;
  std::uint64_t stride_ = 1;
  Revision latest_;
  std::int64_t latest_ns_ = kNever_ns;
};

}  // namespace warren
