// SPDX-License-Identifier: Apache-2.0
// Messages posted, and what became of them.
#include <algorithm>
#include <utility>

#include "tests/fleet/fleet.hpp"

namespace warren::fleet_sim {

// Its application fetches a message as soon as it is there.
void Fleet::take_items(FleetNode& node, std::size_t index) {
  const MemberId self{static_cast<std::uint32_t>(index + 1)};
  while (const auto arrived = node.replication->poll_item()) {
    if (arrived->item.kind != replication::ItemKind::kMessage) continue;
    items_taken_[{arrived->log, arrived->number}].insert(index);
    if (arrived->item.to != self) continue;
    mesh::ByteRanges fetched;
    fetched.add({arrived->number, arrived->number + 1ULL});
    node.replication->log_book().take(now(), arrived->log, fetched);
  }
}

std::optional<replication::ItemNumber> Fleet::post(std::size_t index, std::optional<std::size_t> to,
                                                   std::size_t bytes) {
  FleetNode& node = nodes_[index];
  if (!node.replication) return std::nullopt;
  replication::Item item;
  if (to) item.to = MemberId{static_cast<std::uint32_t>(*to + 1)};
  item.bytes.assign(bytes, static_cast<std::uint8_t>(random_.below(256)));
  const auto number = node.replication->append(now(), std::move(item));
  if (!number) return number;
  posted_.push_back({node.replication->log_book().own()->log.id(), *number, index, to, false});
  simulation_.touch(index);
  return number;
}

std::optional<std::string> Fleet::undelivered() const {
  for (const Posted& posted : posted_) {
    if (posted.excused) continue;
    const auto taken = items_taken_.find({posted.log, posted.number});
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (i == posted.from || (posted.to && *posted.to != i)) continue;
      if (taken == items_taken_.end() || !taken->second.contains(i)) {
        return "item " + std::to_string(posted.number) + " of node " +
               std::to_string(posted.from + 1) + " has not come to node " + std::to_string(i + 1);
      }
    }
  }
  return std::nullopt;
}

// What no store has any more, and its writer neither, may be lost.
void Fleet::excuse(std::size_t index, bool disk) {
  for (Posted& posted : posted_) {
    if (posted.from != index && nodes_[posted.from].replication) continue;
    bool kept = false;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (disk && i == index) continue;
      const auto logs = nodes_[i].disk.logs();
      kept = kept || std::any_of(logs.begin(), logs.end(), [&](const auto& log) {
               return log.id == posted.log && log.seen.contains(posted.number);
             });
    }
    if (!kept) posted.excused = true;
  }
}

}  // namespace warren::fleet_sim
