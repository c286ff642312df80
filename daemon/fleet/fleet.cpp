// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/fleet.hpp"

#include <random>
#include <utility>

#include <asio/post.hpp>

namespace warren {
namespace {

std::uint64_t random_bits() {
  std::random_device device;  // getrandom(2) or the CPU's generator
  return std::uint64_t{device()} << 32 | device();
}

}  // namespace

Fleet::Fleet(asio::io_context& io, Mapper& mapper, const FleetMapConfig& config,
             std::chrono::nanoseconds tick)
    : mapper_(mapper), timer_(io), tick_(tick), map_(config, random_bits) {}

void Fleet::wait_for_tick() {
  timer_.expires_after(tick_);
  timer_.async_wait([this](std::error_code cancelled) {
    if (cancelled || finishing_) return;
    begin_tick();
    wait_for_tick();
  });
}

void Fleet::begin_tick() {
  if (tick_under_way_.exchange(true)) {
    ++ticks_late_;
    return;
  }
  const bool asked = mapper_.ask_changes([this](std::vector<LayerChanges> changes) {
    asio::post(thread_, [this, changes = std::move(changes)] {
      map_.tick(changes);
      tick_under_way_ = false;
    });
  });
  if (asked) return;
  ++ticks_late_;
  tick_under_way_ = false;
}

void Fleet::finish(std::vector<LayerChanges> last, std::function<void()> done) {
  finishing_ = true;
  timer_.cancel();
  asio::post(thread_, [this, last = std::move(last), done = std::move(done)] {
    map_.tick(last);
    map_.flush();
    done();
  });
}

bool Fleet::ask(std::function<void(FleetMap&)> question) {
  if (questions_.fetch_add(1) >= kMaxQuestions) {
    --questions_;
    return false;
  }
  asio::post(thread_, [this, question = std::move(question)] {
    question(map_);
    --questions_;
  });
  return true;
}

}  // namespace warren
