// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/fleet.hpp"

#include <utility>

#include <asio/post.hpp>

#include "daemon/fleet/no_store.hpp"
#include "daemon/random_bits.hpp"

namespace warren {

Fleet::Fleet(asio::io_context& io, Mapper& mapper, const FleetConfig& config)
    : mapper_(mapper),
      timer_(io),
      config_(config),
      running_(asio::make_work_guard(fleet_io_)),
      map_(config.map, random_bits),
      store_(std::make_unique<NoStore>(fleet_io_)) {
  if (config_.mesh) open_mesh(*config_.mesh);
  thread_ = std::thread([this] { fleet_io_.run(); });
}

Fleet::~Fleet() {
  asio::post(fleet_io_, [this] {
    if (mesh_) mesh_->stop();
    running_.reset();
  });
  thread_.join();
}

void Fleet::open_mesh(const FleetMeshConfig& config) {
  mesh_ = std::make_unique<FleetMesh>(fleet_io_, config, map_, *store_);
  map_.on_open([this](const OwnLayer& layer) { mesh_->on_opened(layer); });
}

void Fleet::start() {
  asio::post(fleet_io_, [this] {
    if (mesh_) mesh_->start();
  });
  wait_for_tick();
}

void Fleet::wait_for_tick() {
  timer_.expires_after(config_.tick);
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
    asio::post(fleet_io_, [this, changes = std::move(changes)] {
      tick(changes);
      tick_under_way_ = false;
    });
  });
  if (asked) return;
  ++ticks_late_;
  tick_under_way_ = false;
}

void Fleet::tick(const std::vector<LayerChanges>& changes) {
  map_.tick(changes);
  if (mesh_) mesh_->on_ticked();
}

void Fleet::finish(std::vector<LayerChanges> last, std::function<void()> done) {
  finishing_ = true;
  timer_.cancel();
  asio::post(fleet_io_, [this, last = std::move(last), done = std::move(done)] {
    map_.tick(last);
    map_.flush();
    if (!mesh_) return done();
    mesh_->on_ticked();
    mesh_->drain(config_.shutdown, done);
  });
}

bool Fleet::ask(std::function<void(const FleetParts&)> question) {
  if (questions_.fetch_add(1) >= kMaxQuestions) {
    --questions_;
    return false;
  }
  asio::post(fleet_io_, [this, question = std::move(question)] {
    question({map_, mesh_.get()});
    --questions_;
  });
  return true;
}

void Fleet::request_beat() {
  if (beat_requested_.exchange(true)) return;
  asio::post(fleet_io_, [this] {
    beat_requested_ = false;
    ++beats_;
  });
}

}  // namespace warren
