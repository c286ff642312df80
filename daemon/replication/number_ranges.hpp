// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/delivery/byte_ranges.hpp"

namespace warren::replication {

// The numbers of `all` that are not in `known`.
inline mesh::ByteRanges beyond(const mesh::ByteRanges& all, const mesh::ByteRanges& known) {
  mesh::ByteRanges missing;
  for (const mesh::NumberRange& range : all.ranges()) {
    const mesh::ByteRanges parts = known.missing_in(range);
    for (const mesh::NumberRange& part : parts.ranges()) missing.add(part);
  }
  return missing;
}

inline void add_all(mesh::ByteRanges& to, const mesh::ByteRanges& numbers) {
  for (const mesh::NumberRange& range : numbers.ranges()) to.add(range);
}

}  // namespace warren::replication
