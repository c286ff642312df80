// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "core/voxel/scan.hpp"

namespace warren {

inline constexpr std::uint32_t kIngestProtocolVersion = 1;

struct HelloMessage {
  std::uint32_t protocol_version = 0;
  std::string client;
};

struct ScanMessage {
  std::uint64_t sequence = 0;
  std::string sensor;
  std::uint64_t frame_epoch = 0;
  std::int64_t stamp_ns = 0;
  Scan scan;  // its gravity as sent: any length, perhaps no direction at all
};

struct PoseUpdateMessage {
  std::uint64_t frame_epoch = 0;
  Pose T_fleet_map;
};

using IngestMessage = std::variant<HelloMessage, ScanMessage, PoseUpdateMessage>;

// Why the daemon closes a client.
enum class Refusal : std::uint8_t {
  kHeaderLength,  // zero or above the limit
  kNotProtobuf,   // the header does not parse
  kNoBody,        // none of the known messages
  kNoHello,       // the first message was another one
  kSecondHello,
  kProtocolVersion,
  kLongText,  // a name above its limit
  kUnknownSensor,
  kTooManyPoints,
  kBadExtras,  // too many, twice the same, or of the wrong type
  kTruncated,  // the connection ended within a message
  kStalled,    // a message took longer than ingest.message_timeout_s
  kTooManyClients,
};
inline constexpr std::size_t kRefusalCount = 13;
// snake_case, as it stands in status.
const char* name_of(Refusal refusal);

struct Refused {
  Refusal refusal;
  std::string text;  // for the client: what is wrong
};

}  // namespace warren
