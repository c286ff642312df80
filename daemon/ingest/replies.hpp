// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "daemon/ingest/header.hpp"

namespace warren {

enum class ScanOutcome : std::uint8_t { kTaken, kDroppedOverload, kDroppedOutOfOrder, kRejected };

// What became of one scan.
struct ScanReceipt {
  std::uint64_t sequence = 0;
  ScanOutcome outcome = ScanOutcome::kTaken;
  std::string reason;
  std::uint64_t points_used = 0;
};

// Replies as they go over the wire, length included.
std::string encode_welcome(const IngestLimits& limits, std::uint32_t queue_scans);
std::string encode_receipt(const ScanReceipt& receipt);
std::string encode_pose_updated(std::uint64_t frame_epoch, bool applied);
std::string encode_failure(const std::string& reason);

}  // namespace warren
