// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "daemon/store/head_bytes.hpp"
#include "daemon/store/row_table.hpp"
#include "daemon/store/store_result.hpp"

namespace warren {

// A block of the slot-th layer has the key slot << 39 | ordinal.
inline constexpr int kOrdinalBits = 39;
inline constexpr std::int64_t kSlotsMax = std::int64_t{1} << 24;
constexpr std::int64_t block_row(std::int64_t slot, BlockOrdinal block) {
  return slot << kOrdinalBits | static_cast<std::int64_t>(block);
}
constexpr BlockOrdinal block_of_row(std::int64_t row) {
  return static_cast<BlockOrdinal>(row) & (kOrdinalEnd - 1);
}

// Layers, own ones and copies. Heads are held in memory too, to judge what comes.
class LayerTable {
 public:
  explicit LayerTable(Database& database)
      : heads_(database, "layer"), blocks_(database, "layer_block") {}

  // The heads, read anew.
  void load();
  // Reads every block; how many there are.
  std::size_t verify();

  BatchResult judge(const LayerWrite& write) const;
  // Precondition: judged as kStored. False: the layer was evicted, nothing is written.
  bool write(const LayerWrite& write, std::uint64_t commit);
  void erase(const LayerId& id);
  // No own layer may be written any more.
  void close_own();
  // The least recently written of the others' layers.
  std::optional<LayerId> evict_one();
  // How the transaction ended: what was evicted in it stays so, or not.
  void committed() { evicted_.merge(evicting_); }
  void rolled_back() { evicting_.clear(); }

  std::vector<LayerRow> rows() const;
  std::vector<StoredBlock> blocks(const LayerId& id);

 private:
  struct Entry {
    std::int64_t slot = 0;
    LayerRow row;
  };

  std::int64_t free_slot() const;
  void put_head(const Entry& entry);
  bool is_evicted(const LayerId& id) const {
    return evicted_.contains(id) || evicting_.contains(id);
  }

  RowTable heads_;
  RowTable blocks_;
  std::map<LayerId, Entry> entries_;
  std::set<LayerId> evicted_;
  std::set<LayerId> evicting_;
};

}  // namespace warren
