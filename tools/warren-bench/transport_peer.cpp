// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/transport_peer.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <utility>

#include "tools/warren-bench/transport_peer_output.hpp"
#include "tools/warren-bench/transport_peers.hpp"

namespace warren {
namespace {

constexpr std::int64_t kPrintEveryUs = 1000;

struct Transport {
  std::function<void(const TransportPeerOptions&)> send;
  std::function<void(const TransportPeerOptions&)> receive;
};

Transport tcp(const char* congestion_control) {
  return {[=](const auto& options) { send_by_tcp(options, congestion_control); }, receive_by_tcp};
}

// By name, in the order of the tables.
const std::vector<std::pair<std::string, Transport>>& transports() {
  static const std::vector<std::pair<std::string, Transport>> all{
      {"ours", {send_by_ours, receive_by_ours}},
      {"tcp-cubic", tcp("cubic")},
      {"tcp-bbr", tcp("bbr")},
      {"enet", {send_by_enet, receive_by_enet}},
      {"srt", {send_by_srt, receive_by_srt}}};
  return all;
}

std::int64_t now_us() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

void print(const std::string& line) {
  std::fputs((line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace

void print_ready() { print("ready"); }
void print_start() { print("start " + std::to_string(now_us())); }

void exit_unavailable(const std::string& why) {
  print("unavailable " + why);
  std::_Exit(0);
}

void exit_wrong(const std::string& why) {
  print("wrong " + why);
  std::_Exit(1);
}

void Progress::add(std::size_t bytes) {
  if (bytes == 0) return;
  have_ += bytes;
  const std::int64_t now = now_us();
  if (!is_complete() && now - printed_us_ < kPrintEveryUs) return;
  printed_us_ = now;
  print("at " + std::to_string(now) + " " + std::to_string(have_));
}

const std::vector<std::string>& transport_kinds() {
  static const std::vector<std::string> kinds = [] {
    std::vector<std::string> names;
    for (const auto& [name, transport] : transports()) names.push_back(name);
    return names;
  }();
  return kinds;
}

std::vector<std::string> rival_kinds() {
  std::vector<std::string> kinds = transport_kinds();
  std::erase(kinds, "ours");  // its ports are the fleet's
  return kinds;
}

int run_transport_peer(const TransportPeerOptions& options) {
  for (const auto& [name, transport] : transports()) {
    if (name == options.kind) (options.sends ? transport.send : transport.receive)(options);
  }
  return 0;
}

}  // namespace warren
