// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-link/emulator.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

#include <unistd.h>

namespace warren {
namespace {

constexpr std::size_t kFrameBytesMax = 65'536;
constexpr int kFramesAtOnce = 32;  // then others have their turn

}  // namespace

MeshTime monotonic_now() {
  return std::chrono::time_point_cast<Duration>(std::chrono::steady_clock::now());
}

Emulator::Emulator(LinkModel model, std::vector<FileDescriptor> devices, bool ethernet)
    : model_(std::move(model)),
      devices_(std::move(devices)),
      errors_(devices_.size()),
      ethernet_(ethernet) {}

void Emulator::take_from(std::size_t node) {
  std::array<std::uint8_t, kFrameBytesMax> buffer;
  const std::size_t header = ethernet_ ? MacTable::kHeaderBytes : 0;
  for (int i = 0; i < kFramesAtOnce; ++i) {
    const ssize_t got = read(devices_[node].get(), buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      if (errno != EAGAIN) ++errors_[node].read;
      return;
    }
    const std::span frame(buffer.data(), static_cast<std::size_t>(got));
    if (frame.size() <= header) continue;
    const auto from = static_cast<StationIndex>(node);
    LinkPacket packet{from,
                      static_cast<StationIndex>(1 - node),
                      frame.size() - header,
                      {frame.begin(), frame.end()}};
    if (ethernet_) packet.to = mac_table_.route(from, frame);
    if (packet.to != from) model_.send(monotonic_now(), std::move(packet));
  }
}

MeshTime Emulator::deliver() {
  while (const auto delivery = model_.poll(monotonic_now())) {
    const auto& bytes = delivery->bytes;
    const ssize_t written = write(devices_[delivery->to].get(), bytes.data(), bytes.size());
    if (written < 0) ++errors_[delivery->to].write;
    const Duration late = monotonic_now() - delivery->at;
    ++lateness_.packets;
    lateness_.sum += late;
    lateness_.max = std::max(lateness_.max, late);
  }
  return model_.next_event();
}

}  // namespace warren
