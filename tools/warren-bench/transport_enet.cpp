// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <enet/enet.h>

#include "tools/warren-bench/transport_payload.hpp"
#include "tools/warren-bench/transport_peer_output.hpp"
#include "tools/warren-bench/transport_peers.hpp"

namespace warren {
namespace {

// Below ENet's MTU of 1392 with its headers: a message is a packet.
constexpr std::size_t kPartBytes = 1340;
// Enough to fill its window of 64 kB, few enough to stay bounded.
constexpr std::size_t kQueuedMax = 256;
constexpr enet_uint32 kServiceMs = 5;
constexpr enet_uint32 kPatienceMs = 24 * 3600 * 1000;

// ENet tells by a callback without argument that it has no more use for a packet.
std::size_t g_queued = 0;

ENetAddress address_of(const TransportPeerOptions& options) {
  ENetAddress address{};
  enet_address_set_host_ip(&address, options.address.c_str());
  address.port = options.port;
  return address;
}

ENetHost* make_host(const ENetAddress* address) {
  if (enet_initialize() != 0) exit_wrong("enet_initialize");
  ENetHost* host = enet_host_create(address, 1, 1, 0, 0);
  if (host == nullptr) exit_wrong("enet_host_create");
  return host;
}

// It would give up after 5 to 30 s of silence.
void be_patient(ENetPeer* peer) {
  enet_peer_timeout(peer, std::numeric_limits<enet_uint32>::max(), kPatienceMs, kPatienceMs);
}

void queue_message(ENetPeer* peer, const std::vector<std::uint8_t>& message) {
  ENetPacket* packet =
      enet_packet_create(message.data(), message.size(), ENET_PACKET_FLAG_RELIABLE);
  packet->freeCallback = [](ENetPacket*) { --g_queued; };
  ++g_queued;
  if (enet_peer_send(peer, 0, packet) != 0) exit_wrong("enet_peer_send");
}

}  // namespace

void send_by_enet(const TransportPeerOptions& options) {
  ENetHost* host = make_host(nullptr);
  const ENetAddress address = address_of(options);
  print_start();
  ENetPeer* peer = enet_host_connect(host, &address, 1, 0);
  if (peer == nullptr) exit_wrong("enet_host_connect");
  be_patient(peer);
  std::size_t next = 0;
  for (bool connected = false;;) {
    while (connected && next < options.bytes && g_queued < kQueuedMax) {
      const std::size_t bytes = std::min(kPartBytes, options.bytes - next);
      queue_message(peer, make_payload_part(next, bytes));
      next += bytes;
    }
    ENetEvent event;
    if (enet_host_service(host, &event, kServiceMs) <= 0) continue;
    if (event.type == ENET_EVENT_TYPE_CONNECT) connected = true;
    if (event.type == ENET_EVENT_TYPE_DISCONNECT) exit_wrong("disconnected");
  }
}

void receive_by_enet(const TransportPeerOptions& options) {
  const ENetAddress address = address_of(options);
  ENetHost* host = make_host(&address);
  print_ready();
  PayloadReceived received(options.bytes);
  Progress progress(options.bytes);
  while (!progress.is_complete()) {
    ENetEvent event;
    if (enet_host_service(host, &event, kServiceMs) <= 0) continue;
    if (event.type == ENET_EVENT_TYPE_CONNECT) be_patient(event.peer);
    if (event.type == ENET_EVENT_TYPE_DISCONNECT) exit_wrong("disconnected");
    if (event.type != ENET_EVENT_TYPE_RECEIVE) continue;
    progress.add(received.take({event.packet->data, event.packet->dataLength}));
    enet_packet_destroy(event.packet);
  }
}

}  // namespace warren
