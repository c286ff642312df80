// SPDX-License-Identifier: Apache-2.0
// Saved parcels: what is read keeps its promises, is written back byte for byte, and can be
// restored; then an inbox takes the same bytes as frames and stays within its bounds.
#include <algorithm>
#include <cassert>

#include "tests/fuzz/fuzz_input.hpp"
#include "transport/delivery/inbox.hpp"
#include "transport/delivery/outbox.hpp"
#include "transport/delivery/saved_parcels.hpp"
#include "transport/delivery/scheduler.hpp"

namespace warren::fuzz {

using namespace mesh;
namespace {

constexpr std::size_t kDigestBytes = 16;

void check_restored(const SavedPeer& peer) {
  const TelemetryBoard board;
  ParcelBudget sent(1'000'000);
  ParcelBudget received(1'000'000);
  Outbox outbox(DeliveryConfig{}, 1, board, sent);
  Inbox inbox(DeliveryConfig{}, received);
  outbox.restore(peer.outgoing);
  inbox.restore(peer.incoming);
  assert(outbox.save().parcels == peer.outgoing.parcels);
  assert(inbox.save() == peer.incoming);
  Scheduler scheduler;
  const SendState state{MeshTime{std::chrono::seconds(1)}, 1e6, Duration{100'000}, 60, 1200};
  const auto no_map = [](MapClass, std::size_t) { return std::optional<PulledMap>{}; };
  for (int i = 0; i < 100; ++i) {
    FilledPacket packet;
    scheduler.fill(state, 1200, outbox, inbox, no_map, packet);
    assert(packet.bytes <= 1200);
    if (packet.frames.empty()) break;
  }
}

void check_saved(std::span<const std::uint8_t> bytes) {
  const auto peers = read_saved_parcels_body(bytes);
  if (!peers) return;
  const auto again = encode(*peers);
  assert(again.size() == bytes.size() + kDigestBytes);
  assert(std::equal(bytes.begin(), bytes.end(), again.begin()));
  assert(read_saved_parcels(again) == peers);
  for (const SavedPeer& peer : *peers) check_restored(peer);
}

void check_frames(std::span<const std::uint8_t> content) {
  DeliveryConfig config;
  config.parcel.received_bytes_max = 1'200'000;
  const TelemetryBoard board;
  ParcelBudget sent(1'000'000);
  ParcelBudget received(2'000'000);
  Outbox outbox(config, 1, board, sent);
  Inbox inbox(config, received);
  (void)outbox.send_parcel(ParcelClass::kMessage, std::vector<std::uint8_t>(5000));
  // Packets of up to 40 bytes each, as the first byte of each says.
  while (!content.empty()) {
    const std::size_t size = std::min<std::size_t>(content.front() % 40, content.size() - 1);
    auto frames = read_frames(content.subspan(1, size));
    content = content.subspan(1 + size);
    if (!frames) continue;
    for (Frame& frame : *frames) {
      if (const auto* told = std::get_if<ParcelStateFrame>(&frame)) {
        (void)outbox.on_state(MeshTime{}, *told);
        continue;
      }
      const auto taken = inbox.on_frame(std::move(frame));
      if (!taken) continue;
      if (const auto* parcel = std::get_if<ParcelInbox::Arrived>(&*taken))
        inbox.finish_parcel(parcel->key);
    }
    assert(inbox.unfinished_bytes() <=
           config.parcel.received_bytes_max + ParcelInbox::kRangeBytesMax);
    assert(received.used() == inbox.unfinished_bytes());
  }
}

}  // namespace
}  // namespace warren::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  warren::fuzz::check_saved({data, size});
  warren::fuzz::check_frames({data, size});
  return 0;
}
