// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>

#include "tools/warren-bench/transport_peer.hpp"

// The transports that are compared. Senders do not return before they are killed; receivers return
// when they have all.
namespace warren {

// Of the receiver, for those that take a socket's address.
inline sockaddr_in socket_address_of(const TransportPeerOptions& options) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(options.port);
  inet_pton(AF_INET, options.address.c_str(), &address.sin_addr);
  return address;
}

void send_by_tcp(const TransportPeerOptions& options, const char* congestion_control);
void receive_by_tcp(const TransportPeerOptions& options);
void send_by_enet(const TransportPeerOptions& options);
void receive_by_enet(const TransportPeerOptions& options);
void send_by_srt(const TransportPeerOptions& options);
void receive_by_srt(const TransportPeerOptions& options);
void send_by_ours(const TransportPeerOptions& options);
void receive_by_ours(const TransportPeerOptions& options);

}  // namespace warren
