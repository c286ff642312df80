// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "daemon/replication/item.hpp"
#include "transport/wire/packet_reader.hpp"
#include "transport/wire/packet_writer.hpp"

namespace warren::replication {

inline constexpr std::uint64_t kItemNumberEnd = std::uint64_t{UINT32_MAX};

void write(mesh::PacketWriter& to, const LogId& log);
std::optional<LogId> read_log_id(mesh::PacketReader& from);
// The lowest kRangesMax of the ranges: how many; of each the numbers left out before it, and its
// length.
void write(mesh::PacketWriter& to, const mesh::ByteRanges& numbers);
std::optional<mesh::ByteRanges> read_ranges(mesh::PacketReader& from);

}  // namespace warren::replication
