// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace warren {

enum class StoreError : std::uint8_t {
  kInUse,         // another process has the file open
  kNewerVersion,  // a later release of Warren wrote the file
  kNotAStore,     // a database, but not one of ours: not touched
  kCeiling,       // StoreConfig::disk_bytes_max, and nothing is left that may go
  kDiskFull,
  kIo,
  kCorrupt,
};
// A few words, without a dot.
const char* text_of(StoreError error);

// What went wrong, and with what, for the log.
struct StoreFailure {
  StoreError error = StoreError::kIo;
  std::string text;
};

}  // namespace warren
