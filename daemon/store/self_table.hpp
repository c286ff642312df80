// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "daemon/store/head_bytes.hpp"
#include "daemon/store/row_table.hpp"
#include "daemon/store/store_result.hpp"

namespace warren {

// The layers of the self-map at full probability.
class SelfTable {
 public:
  explicit SelfTable(Database& database)
      : heads_(database, "self_layer"), blocks_(database, "self_block") {}

  // The heads, read anew.
  void load();
  // Reads every block; how many there are.
  std::size_t verify();
  BatchResult judge(const SelfLayerWrite& write) const;
  // Precondition: judged as kStored.
  void write(const SelfLayerWrite& write);

  std::vector<SelfLayerHead> heads() const;
  // False: a block is none that a map of this config could have.
  bool fill(const SelfLayerHead& head, SelfMap& map);

 private:
  RowTable heads_;
  RowTable blocks_;
  std::map<std::uint32_t, SelfLayerHead> entries_;
};

}  // namespace warren
