// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/voxel/scan.hpp"
#include "tools/client/unix_stream.hpp"

namespace warren {

struct OutgoingScan {
  std::uint64_t sequence = 0;
  std::string sensor;
  std::uint64_t frame_epoch = 0;
  std::int64_t stamp_ns = 0;
  Scan scan;
};

enum class ScanOutcome : std::uint8_t { kTaken, kDroppedOverload, kDroppedOutOfOrder, kRejected };

struct Receipt {
  std::uint64_t sequence = 0;
  ScanOutcome outcome = ScanOutcome::kTaken;
  std::string reason;
};

// What the daemon said of itself when we connected.
struct IngestWelcome {
  std::uint32_t queue_scans = 1;
  std::uint64_t max_payload_bytes = 0;
  std::vector<std::string> sensors;
};

// One connection to a daemon's ingest socket (docs/PROTOCOL.md). Blocking; one thread.
class IngestClient {
 public:
  // Connects and greets; waits at most `patience` for the welcome.
  static tl::expected<IngestClient, std::string> connect(
      const std::string& socket, const std::string& client_name,
      std::chrono::milliseconds patience = std::chrono::seconds(10));

  const IngestWelcome& welcome() const { return welcome_; }
  tl::expected<void, std::string> send(const OutgoingScan& scan);
  // The next receipt; nothing if none came within the timeout; the daemon's own words if it
  // refused.
  tl::expected<std::optional<Receipt>, std::string> receive(std::chrono::milliseconds timeout);

 private:
  explicit IngestClient(UnixStream stream) : stream_(std::move(stream)) {}
  tl::expected<void, std::string> greet(const std::string& client_name,
                                        std::chrono::milliseconds patience);

  UnixStream stream_;
  IngestWelcome welcome_;
};

}  // namespace warren
