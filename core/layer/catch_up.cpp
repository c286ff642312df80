// SPDX-License-Identifier: Apache-2.0
#include "core/layer/catch_up.hpp"

#include <algorithm>
#include <utility>

namespace warren {
namespace {

bool any_changed(const Replica& sender, const KeyInterval& keys, Revision from) {
  bool any = false;
  if (keys.empty()) return any;
  sender.for_each_changed(keys, from, [&](BlockOrdinal, const LayerBlock&) {
    any = true;
    return false;
  });
  return any;
}

// An interval and its place in the order of sending.
struct Part {
  KeyInterval keys;
  std::size_t rank = 0;
};

std::vector<Part> joined(std::vector<Part> parts, const Replica& sender, Revision from) {
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return a.keys.first < b.keys.first; });
  std::vector<Part> result;
  for (const Part& part : parts) {
    if (result.empty() || any_changed(sender, {result.back().keys.end, part.keys.first}, from)) {
      result.push_back(part);
      continue;
    }
    result.back().keys.end = part.keys.end;
    result.back().rank = std::min(result.back().rank, part.rank);
  }
  return result;
}

}  // namespace

std::vector<KeyInterval> catch_up_parts(const Replica& sender, Revision from) {
  const auto changed = sender.regions_by_change(from, kHotRegionsMax * kChangedPerHotRegion);
  std::vector<Part> hot;
  for (std::size_t rank = 0; rank < changed.size() / kChangedPerHotRegion; ++rank) {
    hot.push_back({changed[rank], rank});
  }
  hot = joined(std::move(hot), sender, from);
  std::sort(hot.begin(), hot.end(), [](const Part& a, const Part& b) { return a.rank < b.rank; });
  std::vector<KeyInterval> parts;
  parts.reserve(hot.size() + 1);
  for (const Part& part : hot) parts.push_back(part.keys);
  parts.push_back({});
  return parts;
}

}  // namespace warren
