// SPDX-License-Identifier: Apache-2.0
#include "daemon/ingest/decoder.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

#include "proto/framing.hpp"

namespace warren {
namespace {

static_assert(std::endian::native == std::endian::little, "the wire's floats are read in place");
static_assert(sizeof(Point3f) == kPointBytes);

// Extras have no use yet: they are read over through one buffer of this size.
constexpr std::size_t kSkipBytes = std::size_t{16} * 1024;

}  // namespace

std::size_t IngestDecoder::part_bytes() const {
  switch (part_) {
    case Part::kLength:
      return length_.size();
    case Part::kHeader:
      return header_bytes_.size();
    case Part::kPoints:
      return header_.payload.points * kPointBytes;
    case Part::kNoReturns:
      return header_.payload.no_returns * kPointBytes;
    case Part::kExtras:
      break;
  }
  return header_.payload.extra_bytes;
}

std::span<std::byte> IngestDecoder::payload_buffer(std::vector<Point3f>& points) {
  const std::size_t end = std::min(part_bytes(), filled_ + kChunkBytes);
  const std::size_t needed = (end + kPointBytes - 1) / kPointBytes;
  if (points.size() < needed) points.resize(needed);
  return std::as_writable_bytes(std::span(points)).subspan(filled_, end - filled_);
}

std::span<std::byte> IngestDecoder::buffer() {
  switch (part_) {
    case Part::kLength:
      return std::span(length_).subspan(filled_);
    case Part::kHeader:
      return std::span(header_bytes_).subspan(filled_);
    case Part::kPoints:
      return payload_buffer(points_);
    case Part::kNoReturns:
      return payload_buffer(no_returns_);
    case Part::kExtras:
      break;
  }
  skipped_.resize(kSkipBytes);
  return std::span(skipped_).first(std::min(part_bytes() - filled_, kSkipBytes));
}

tl::expected<std::optional<IngestMessage>, Refused> IngestDecoder::commit(
    std::size_t count, const IngestLimits& limits) {
  filled_ += count;
  assert(filled_ <= part_bytes());
  while (filled_ == part_bytes()) {
    if (const auto finished = finish_part(limits); !finished) {
      return tl::unexpected(finished.error());
    }
    if (part_ == Part::kLength) return take_message();
  }
  return std::nullopt;
}

// Moves on to the next part; to kLength when the message is whole.
tl::expected<void, Refused> IngestDecoder::finish_part(const IngestLimits& limits) {
  filled_ = 0;
  switch (part_) {
    case Part::kLength:
      part_ = Part::kHeader;
      return finish_length();
    case Part::kHeader:
      part_ = Part::kPoints;
      return finish_header(limits);
    case Part::kPoints:
      part_ = Part::kNoReturns;
      return {};
    case Part::kNoReturns:
      part_ = Part::kExtras;
      return {};
    case Part::kExtras:
      part_ = Part::kLength;
      return {};
  }
  return {};
}

tl::expected<void, Refused> IngestDecoder::finish_length() {
  const std::uint32_t length = read_length(length_);
  if (length == 0 || length > kMaxIngestHeaderBytes) {
    return tl::unexpected(
        Refused{Refusal::kHeaderLength, "a header's length must be 1 to 65536 bytes"});
  }
  header_bytes_.resize(length);
  return {};
}

tl::expected<void, Refused> IngestDecoder::finish_header(const IngestLimits& limits) {
  auto header = decode_ingest_header(header_bytes_, limits);
  if (!header) return tl::unexpected(std::move(header.error()));
  const bool is_hello = std::holds_alternative<HelloMessage>(header->message);
  if (is_hello && greeted_) {
    return tl::unexpected(Refused{Refusal::kSecondHello, "hello was said before"});
  }
  if (!is_hello && !greeted_) {
    return tl::unexpected(Refused{Refusal::kNoHello, "the first message must be a hello"});
  }
  greeted_ = true;
  header_ = std::move(*header);
  return {};
}

IngestMessage IngestDecoder::take_message() {
  if (auto* const message = std::get_if<ScanMessage>(&header_.message)) {
    message->scan.points_sensor = std::move(points_);
    message->scan.no_return_directions_sensor = std::move(no_returns_);
  }
  points_.clear();
  no_returns_.clear();
  return std::move(header_.message);
}

}  // namespace warren
