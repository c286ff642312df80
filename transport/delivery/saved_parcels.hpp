// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transport/mesh_id.hpp"
#include "transport/wire/frames.hpp"

namespace warren::mesh {

// What an outbox keeps through a restart.
struct SavedOutgoing {
  struct Parcel {
    std::uint32_t number = 0;
    ParcelClass priority = ParcelClass::kMessage;
    std::vector<std::uint8_t> bytes;
    friend bool operator==(const Parcel&, const Parcel&) = default;
  };
  std::uint64_t stream = 0;
  std::uint32_t next_number = 0;
  std::vector<Parcel> parcels;  // unfinished, by number, all before next_number
  friend bool operator==(const SavedOutgoing&, const SavedOutgoing&) = default;
};

// What an inbox keeps.
struct SavedIncoming {
  static constexpr std::size_t kRangesMax = 4096;
  struct Stream {
    std::uint64_t id = 0;
    std::uint32_t finished_before = 0;
    std::vector<NumberRange> finished;  // from finished_before on; in order, not touching
    friend bool operator==(const Stream&, const Stream&) = default;
  };
  std::optional<Stream> stream;
  std::optional<std::uint64_t> previous_stream;
  friend bool operator==(const SavedIncoming&, const SavedIncoming&) = default;
};

struct SavedPeer {
  MemberId member;
  SavedOutgoing outgoing;
  SavedIncoming incoming;
  friend bool operator==(const SavedPeer&, const SavedPeer&) = default;
};

// With a version and a digest. Precondition: by member, none twice.
std::vector<std::uint8_t> encode(std::span<const SavedPeer> peers);
// Nothing unless the bytes are whole and keep what is said above.
std::optional<std::vector<SavedPeer>> read_saved_parcels(std::span<const std::uint8_t> bytes);
// The same without the digest at the end: for the fuzzer.
std::optional<std::vector<SavedPeer>> read_saved_parcels_body(std::span<const std::uint8_t> body);

}  // namespace warren::mesh
