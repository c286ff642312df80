// SPDX-License-Identifier: Apache-2.0
#include "tests/transport/delivery/toy_node.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace warren::mesh::test {

namespace {

std::vector<std::uint8_t> bytes_of(std::uint32_t number) {
  std::vector<std::uint8_t> bytes(4);
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(number >> 8 * i);
  return bytes;
}

std::uint32_t number_in(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number |= std::uint32_t{bytes.at(i)} << 8 * i;
  return number;
}

}  // namespace

std::vector<std::uint8_t> parcel_bytes(std::uint64_t id, std::size_t size) {
  Random random(id);
  std::vector<std::uint8_t> bytes(std::max<std::size_t>(size, 8));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(id >> 8 * i);
  return bytes;
}

std::uint64_t parcel_id(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t id = 0;
  for (std::size_t i = 0; i < 8; ++i) id |= std::uint64_t{bytes.at(i)} << 8 * i;
  return id;
}

ToyNode::ToyNode(const DeliveryConfig& config, std::uint64_t seed)
    : config_(config), random_(seed) {
  begin_life();
}

void ToyNode::begin_life() {
  ++life_;
  arrived_.clear();
  outbox_.reset();
  inbox_.reset();
  board_ = std::make_unique<TelemetryBoard>();
  sent_ = std::make_unique<ParcelBudget>(32'000'000);
  received_ = std::make_unique<ParcelBudget>(32'000'000);
  outbox_ = std::make_unique<Outbox>(config_, random_(), *board_, *sent_);
  inbox_ = std::make_unique<Inbox>(config_, *received_);
  scheduler_ = std::make_unique<Scheduler>();
}

std::optional<ParcelKey> ToyNode::send_parcel(std::uint64_t id, std::size_t size,
                                              ParcelClass priority) {
  const auto key = outbox_->send_parcel(priority, parcel_bytes(id, size));
  if (!key) return std::nullopt;
  assert(!ids_.contains(*key));
  ids_[*key] = id;
  sent.insert(id);
  unsaved_.insert(id);
  return *key;
}

void ToyNode::set_telemetry(std::uint16_t key, std::uint32_t value) {
  if (board_->set(key, bytes_of(value))) outbox_->on_telemetry_set(key);
}

void ToyNode::send_urgent(MeshTime now, std::uint32_t number) {
  outbox_->send_urgent(now, bytes_of(number));
}

FilledPacket ToyNode::fill(MeshTime now, std::size_t room) {
  FilledPacket packet;
  const SendState state{now, 125'000.0, std::chrono::milliseconds(50), 60, room};
  const auto no_map = [](MapClass, std::size_t) { return std::optional<PulledMap>{}; };
  scheduler_->fill(state, room, *outbox_, *inbox_, no_map, packet);
  assert(packet.bytes <= room);
  return packet;
}

void ToyNode::on_frames(MeshTime now, std::vector<Frame> frames) {
  for (Frame& frame : frames) {
    if (const auto* state = std::get_if<ParcelStateFrame>(&frame)) {
      const auto key = outbox_->on_state(now, *state);
      if (key) delivered.push_back(ids_.at(*key));
      continue;
    }
    auto received = inbox_->on_frame(std::move(frame));
    if (!received) continue;
    if (auto* parcel = std::get_if<ParcelInbox::Arrived>(&*received))
      arrived_.push_back(std::move(*parcel));
    if (const auto* message = std::get_if<UrgentReceived>(&*received))
      urgent.push_back(number_in(message->bytes));
    if (const auto* value = std::get_if<TelemetryReceived>(&*received))
      telemetry[value->key].push_back(number_in(value->bytes));
  }
}

void ToyNode::store_some(double share) {
  bool any = false;
  for (std::size_t i = arrived_.size(); i > 0; --i) {
    ParcelInbox::Arrived parcel = std::move(arrived_.front());
    arrived_.pop_front();
    if (!chance(random_, share)) {
      arrived_.push_back(std::move(parcel));
      continue;
    }
    const std::uint64_t id = parcel_id(parcel.bytes);
    assert(parcel.bytes == parcel_bytes(id, parcel.bytes.size()));
    ++stored[id];
    inbox_->finish_parcel(parcel.key);
    any = true;
  }
  if (any) save();
}

void ToyNode::save() {
  const SavedPeer peer{{1}, outbox_->save(), inbox_->save()};
  saved_ = encode({&peer, 1});
  promised.merge(unsaved_);
  unsaved_.clear();
}

void ToyNode::restart() {
  begin_life();
  unsaved_.clear();
  if (saved_.empty()) return;
  auto peers = read_saved_parcels(saved_);
  assert(peers && peers->size() == 1);
  outbox_->restore(std::move(peers->front().outgoing));
  inbox_->restore(peers->front().incoming);
  save();
}

void ToyNode::on_peer_restarted() {
  outbox_->on_peer_restarted();
  inbox_->on_peer_restarted();
  scheduler_->wake();
}

}  // namespace warren::mesh::test
