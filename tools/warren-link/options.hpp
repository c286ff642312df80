// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "tools/link/link_model.hpp"

namespace warren {

// One direction, as numbers with a name each; 0 switches off what can be switched off.
struct LinkSettings {
  double rate_bit_s = 0.0;
  double delay_ms = 0.0;
  double jitter_ms = 0.0;
  double jitter_reorders = 0.0;
  double loss = 0.0;
  double burst_loss = 0.0;
  double burst_packets = 20.0;
  double reorder = 0.0;
  double reorder_ms = 10.0;
  double duplicate = 0.0;
  double corrupt = 0.0;
  double mtu_bytes = 0.0;
};

// A setting as a flag (--name) and in --link (name=value).
struct LinkSetting {
  const char* name;
  double LinkSettings::*value;
  double least;
  double most;
  const char* help;
};
inline constexpr std::array kLinkSettings{
    LinkSetting{"rate", &LinkSettings::rate_bit_s, 0, 1e10, "bit/s, IP bytes; 0: no limit"},
    LinkSetting{"delay-ms", &LinkSettings::delay_ms, 0, 1e6, "of propagation, one way"},
    LinkSetting{"jitter-ms", &LinkSettings::jitter_ms, 0, 1e6, "evenly around the delay"},
    LinkSetting{"jitter-reorders", &LinkSettings::jitter_reorders, 0, 1,
                "1: a late packet is overtaken; 0: those behind it wait"},
    LinkSetting{"loss", &LinkSettings::loss, 0, 1, "share of packets, independent"},
    LinkSetting{"burst-loss", &LinkSettings::burst_loss, 0, 0.99, "share of packets, in bursts"},
    LinkSetting{"burst-packets", &LinkSettings::burst_packets, 1, 1e6, "mean length of a burst"},
    LinkSetting{"reorder", &LinkSettings::reorder, 0, 1, "share of packets that come later"},
    LinkSetting{"reorder-ms", &LinkSettings::reorder_ms, 0, 1e6, "by so much"},
    LinkSetting{"duplicate", &LinkSettings::duplicate, 0, 1, "share of packets"},
    LinkSetting{"corrupt", &LinkSettings::corrupt, 0, 1, "share of packets with flipped bits"},
    LinkSetting{"mtu", &LinkSettings::mtu_bytes, 0, 65535,
                "larger packets are dropped without a word; 0: no limit"},
};

struct LinkOptions {
  bool ethernet = false;  // TAP and any number of nodes; or TUN and two
  std::size_t nodes = 2;
  bool shared_airtime = false;
  LinkSettings link;
  std::vector<std::string> overrides;                  // FROM,TO,NAME=VALUE,..
  std::vector<std::pair<double, double>> blackouts_s;  // from, until
  std::string trace;                                   // of all directions
  std::string trace_back;                              // of node 1 to node 0, instead
  std::size_t queue_packets = 1000;
  std::optional<std::size_t> queue_bytes;
  std::optional<double> queue_ms;
  std::optional<double> seconds;  // how long to run
  std::optional<int> neighbour_retry_ms;
  std::uint64_t seed = 1;
  std::string stats;  // file; empty: standard output
  bool control = false;
  std::vector<std::string> command;  // run in every node
};

// The model with the links between all nodes, or what is wrong.
tl::expected<LinkModel, std::string> make_model(const LinkOptions& options, MeshTime start);

}  // namespace warren
