// SPDX-License-Identifier: Apache-2.0
// A packet of the mesh, as it comes from the air and as content that somebody sealed: whatever
// opens is what we would seal, whatever frames are read encode to the same bytes.
#include <algorithm>
#include <cassert>
#include <numeric>

#include "tests/fuzz/fuzz_input.hpp"
#include "transport/wire/envelope.hpp"
#include "transport/wire/frames.hpp"

namespace warren::fuzz {

using namespace mesh;
namespace {

// Of the golden vectors: packets among the seeds open.
constexpr BootId kReceiver{0xFEDCBA9876543210};

Key fleet_key() {
  Key key{};
  std::iota(key.begin(), key.end(), std::uint8_t{0});
  return key;
}

void check_frames(std::span<const std::uint8_t> content) {
  const auto frames = read_frames(content);
  if (!frames) return;
  std::vector<std::uint8_t> again;
  std::size_t bytes = 0;
  for (const Frame& frame : *frames) {
    append(again, frame);
    bytes += encoded_bytes(frame);
  }
  assert(std::ranges::equal(again, content));
  assert(bytes == content.size());
}

void check_packet(std::span<const std::uint8_t> packet) {
  const auto header = read_packet_header(packet);
  if (!header) return;
  const PresharedKeys keys(fleet_key());
  const Key key = header->type == PacketType::kPair ? keys.pair_key(header->sender, kReceiver)
                                                    : keys.group_key(header->sender);
  const auto content = open(key, packet);
  if (!content) return;
  assert(std::ranges::equal(seal(key, *header, *content), packet));
  check_frames(*content);
}

}  // namespace
}  // namespace warren::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  warren::fuzz::check_packet({data, size});
  warren::fuzz::check_frames({data, size});
  return 0;
}
