// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/warren-bench/transport_peer.hpp"

// The transports that are compared. Senders do not return before they are killed; receivers return
// when they have all.
namespace warren {

void send_by_tcp(const TransportPeerOptions& options, const char* congestion_control);
void receive_by_tcp(const TransportPeerOptions& options);
void send_by_enet(const TransportPeerOptions& options);
void receive_by_enet(const TransportPeerOptions& options);
void send_by_srt(const TransportPeerOptions& options);
void receive_by_srt(const TransportPeerOptions& options);
void send_by_ours(const TransportPeerOptions& options);
void receive_by_ours(const TransportPeerOptions& options);

}  // namespace warren
