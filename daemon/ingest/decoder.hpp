// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <tl/expected.hpp>

#include "daemon/ingest/header.hpp"

namespace warren {

// Turns one client's byte stream into messages, without a socket: ask where the next bytes go, put
// some there, tell how many. Points are read straight into the scan's vectors, which grow as bytes
// arrive, never by what a header announces. After a refusal the decoder is finished.
class IngestDecoder {
 public:
  // What is read in one piece, at most.
  static constexpr std::size_t kChunkBytes = std::size_t{256} * 1024;

  // Where the next bytes of the stream go; never empty.
  std::span<std::byte> buffer();

  // Takes note of the first `count` bytes of buffer(); a message when one became whole. `limits`
  // may change between messages.
  tl::expected<std::optional<IngestMessage>, Refused> commit(std::size_t count,
                                                             const IngestLimits& limits);

  // Some bytes of a message are there, others are missing.
  bool is_within_message() const { return part_ != Part::kLength || filled_ > 0; }

 private:
  // Every message passes through the parts in this order; empty parts are skipped.
  enum class Part { kLength, kHeader, kPoints, kNoReturns, kExtras };

  std::size_t part_bytes() const;
  std::span<std::byte> payload_buffer(std::vector<Point3f>& points);
  tl::expected<void, Refused> finish_part(const IngestLimits& limits);
  tl::expected<void, Refused> finish_length();
  tl::expected<void, Refused> finish_header(const IngestLimits& limits);
  IngestMessage take_message();

  Part part_ = Part::kLength;
  std::size_t filled_ = 0;  // bytes of this part that are there
  std::array<std::byte, 4> length_{};
  std::vector<std::byte> header_bytes_;
  IngestHeader header_;
  std::vector<Point3f> points_;
  std::vector<Point3f> no_returns_;
  std::vector<std::byte> skipped_;
  bool greeted_ = false;
};

}  // namespace warren
