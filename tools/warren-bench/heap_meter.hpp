// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace warren {

// Live heap of this process, counted by the replaced operator new while a meter exists. Counting
// costs time: keep it apart from passes that are timed. One at a time, in a one-threaded program.
class HeapMeter {
 public:
  HeapMeter();
  ~HeapMeter();
  HeapMeter(const HeapMeter&) = delete;
  HeapMeter& operator=(const HeapMeter&) = delete;

  // Largest number of bytes that were live at once since the meter was made, beyond what was then.
  std::size_t peak_bytes() const;
};

}  // namespace warren
