// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "daemon/store/database.hpp"

namespace warren {

inline constexpr std::int64_t kSchemaVersion = 1;
inline constexpr std::int64_t kApplicationId = 0x5752'4E31;  // "WRN1"
inline constexpr std::uint64_t kPageBytes = 4096;

// Makes of an open file one that this release can use: tells what it is, sets it to durable
// commits, brings an older schema up to date. Whether it was made just now; on failure the database
// says why, and the file's content is as it was.
bool prepare(Database& database);

// What SQLite itself finds wrong with the file goes to the database's failure.
void check_pages(Database& database);

}  // namespace warren
