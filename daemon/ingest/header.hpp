// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "daemon/ingest/messages.hpp"

namespace warren {

inline constexpr std::size_t kMaxIngestHeaderBytes = 65536;
inline constexpr std::size_t kMaxClientTextBytes = 64;
inline constexpr std::size_t kMaxExtras = 8;
inline constexpr std::size_t kMaxExtraNameBytes = 32;
inline constexpr std::size_t kPointBytes = 12;
inline constexpr std::size_t kMaxExtraBytes = 4;

// What a client may send.
struct IngestLimits {
  std::uint32_t max_points = 0;
  std::vector<std::string> sensors;

  std::uint64_t max_payload_bytes() const {
    return std::uint64_t{max_points} * (kPointBytes + kMaxExtras * kMaxExtraBytes);
  }
};

// How many elements follow a scan's header.
struct PayloadSizes {
  std::size_t points = 0;
  std::size_t no_returns = 0;
  std::size_t extra_bytes = 0;
};

struct IngestHeader {
  IngestMessage message;  // a scan's arrays are still empty
  PayloadSizes payload;   // all zero unless it is a scan
};

// Parses and checks a header. Nothing is allocated by what it announces.
tl::expected<IngestHeader, Refused> decode_ingest_header(std::span<const std::byte> bytes,
                                                         const IngestLimits& limits);

// Protobuf writes a line to stderr for every malformed string; a client must not fill the log so.
void silence_protobuf();

}  // namespace warren
