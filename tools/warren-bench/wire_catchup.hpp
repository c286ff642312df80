// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/layer/replica.hpp"
#include "tools/warren-bench/wire_tape.hpp"

namespace warren {

// What a copy costs that held everything up to a moment and missed the rest.
struct CatchUp {
  double missed_share = 0.0;  // of the ticks, at the end of the run
  std::uint64_t bytes = 0;
  std::uint64_t relay_bytes = 0;  // from a relay that was itself fed in bulk in the end
  // The same without the hot regions first: what those cost is the difference.
  std::uint64_t key_order_bytes = 0;
  std::uint64_t relay_key_order_bytes = 0;
  // Of the blocks that changed meanwhile, whole, as they are in the end.
  std::uint64_t snapshot_bytes = 0;

  double ratio() const { return share(bytes); }
  double relay_ratio() const { return share(relay_bytes); }
  double key_order_ratio() const { return share(key_order_bytes); }
  double relay_key_order_ratio() const { return share(relay_key_order_bytes); }

 private:
  double share(std::uint64_t of) const {
    return of == 0 ? 0.0 : static_cast<double>(of) / static_cast<double>(snapshot_bytes);
  }
};

// As a sender does it: part by part, from what the copy says that it holds. Nothing if a packet was
// not taken.
std::optional<std::uint64_t> catch_up(const Replica& source, Replica& copy,
                                      std::size_t packet_bytes);

// `origin` is the tape's exact layer in the end. Nothing if a copy did not end equal to it.
std::optional<std::vector<CatchUp>> bench_catch_up(const WireTape& tape, const Replica& origin,
                                                   const WireOptions& options);

}  // namespace warren
