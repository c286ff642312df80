// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/fleet.hpp"

#include <utility>

#include <asio/post.hpp>

#include "daemon/random_bits.hpp"

namespace warren {
namespace {

std::vector<SelfLayerWrite> to_store(std::vector<LayerChanges>& changes) {
  std::vector<SelfLayerWrite> writes;
  for (LayerChanges& layer : changes) {
    if (layer.to_store) writes.push_back(std::move(*layer.to_store));
  }
  return writes;
}

}  // namespace

Fleet::Fleet(asio::io_context& io, Mapper& mapper, const FleetConfig& config, FleetStart start)
    : mapper_(mapper),
      timer_(io),
      config_(config),
      running_(asio::make_work_guard(fleet_io_)),
      map_(config.map, random_bits),
      no_store_(fleet_io_),
      store_(start.store ? std::make_optional<NodeStore>(fleet_io_, std::move(*start.store))
                         : std::nullopt),
      mesh_(fleet_io_, config.mesh, map_,
            store_ ? static_cast<StorePort&>(*store_) : static_cast<StorePort&>(no_store_)) {
  map_.on_open([this](const OwnLayer& layer) { mesh_.on_opened(layer); });
  map_.restore(std::move(start.own));
  mesh_.restore(std::move(start.fleet));
  thread_ = std::thread([this] { fleet_io_.run(); });
}

Fleet::~Fleet() {
  asio::post(fleet_io_, [this] {
    mesh_.stop();
    running_.reset();
  });
  thread_.join();
}

void Fleet::start() {
  asio::post(fleet_io_, [this] { mesh_.start(); });
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
  mapper_.ask_changes([this](std::vector<LayerChanges> changes) {
    asio::post(fleet_io_, [this, changes = std::move(changes)]() mutable {
      tick(std::move(changes));
      tick_under_way_ = false;
    });
  });
}

void Fleet::tick(std::vector<LayerChanges> changes) {
  map_.tick(changes);
  mesh_.on_ticked(to_store(changes));
}

void Fleet::finish(std::vector<LayerChanges> last, std::function<void()> done) {
  finishing_ = true;
  timer_.cancel();
  asio::post(fleet_io_, [this, last = std::move(last), done = std::move(done)]() mutable {
    map_.tick(last);
    map_.flush();
    mesh_.on_ticked(to_store(last));
    mesh_.drain(config_.shutdown, std::move(done));
  });
}

std::optional<StoreStatus> Fleet::store_status() const {
  return store_ ? std::optional(store_->worker().status()) : std::nullopt;
}

bool Fleet::ask(std::function<void(const FleetParts&)> question) {
  if (questions_.fetch_add(1) >= kMaxQuestions) {
    --questions_;
    return false;
  }
  asio::post(fleet_io_, [this, question = std::move(question)] {
    question({map_, mesh_});
    --questions_;
  });
  return true;
}

std::uint64_t Fleet::store_beats() const { return store_ ? store_->worker().beats() : 0; }

void Fleet::request_beat() {
  if (store_) store_->worker().request_beat();
  if (beat_requested_.exchange(true)) return;
  asio::post(fleet_io_, [this] {
    beat_requested_ = false;
    ++beats_;
  });
}

}  // namespace warren
