// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/parcel_outbox.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace warren::mesh {
namespace {

constexpr std::uint32_t kNumberEnd = std::numeric_limits<std::uint32_t>::max();
// Smaller pieces are not worth their header, unless a gap or the end needs no more.
constexpr std::size_t kPieceMin = 64;
// Among so many the one with the least left to send is looked for.
constexpr std::size_t kLookedAt = 64;
// More questions than these per ParcelConfig::ask_after are not asked.
constexpr std::size_t kQuestionsAtOnce = 8;

NumberRange all_of(std::span<const std::uint8_t> bytes) { return {0, bytes.size()}; }

}  // namespace

ParcelOutbox::ParcelOutbox(const ParcelConfig& config, std::uint64_t fresh_stream,
                           ParcelBudget& budget, OutboxCounts& counts)
    : config_(config),
      budget_(budget),
      counts_(counts),
      fresh_stream_(fresh_stream),
      stream_(fresh_stream) {}

ParcelOutbox::~ParcelOutbox() { budget_.give_back(bytes_); }

tl::expected<ParcelKey, ParcelRefusal> ParcelOutbox::send(ParcelClass priority,
                                                          std::span<const std::uint8_t> bytes) {
  const auto refuse = [&](ParcelRefusal why) {
    ++counts_.parcels_refused;
    return tl::unexpected(why);
  };
  if (bytes.size() > ParcelFrame::kBytesMax) return refuse(ParcelRefusal::kTooLarge);
  const std::size_t charge = ParcelBudget::charge(bytes.size());
  if (parcels_.size() >= config_.unfinished_max || bytes_ + charge > config_.sent_bytes_max)
    return refuse(ParcelRefusal::kFull);
  if (next_number_ == kNumberEnd) {
    if (!parcels_.empty()) return refuse(ParcelRefusal::kFull);
    stream_ = ++fresh_stream_;
    next_number_ = 0;
  }
  if (!budget_.take(charge)) return refuse(ParcelRefusal::kFull);
  const std::uint32_t number = next_number_++;
  add(number, priority, {bytes.begin(), bytes.end()});
  return ParcelKey{stream_, number};
}

// Precondition: the budget is charged.
void ParcelOutbox::add(std::uint32_t number, ParcelClass priority,
                       std::vector<std::uint8_t> bytes) {
  bytes_ += ParcelBudget::charge(bytes.size());
  const auto [parcel, added] = parcels_.emplace(number, Parcel{});
  assert(added);
  parcel->second.priority = priority;
  parcel->second.bytes = std::move(bytes);
  parcel->second.to_send.add(all_of(parcel->second.bytes));
  note_sendable(parcel);
  // The question about an empty parcel brings all of it.
  ask_if_complete(parcel, MeshTime::min());
}

std::optional<OutgoingFrame> ParcelOutbox::next(std::size_t room, ParcelClass priority) {
  const auto number = choose(priority);
  if (!number) return std::nullopt;
  const auto found = parcels_.find(*number);
  Parcel& parcel = found->second;
  const NumberRange gap = parcel.to_send.ranges().front();
  if (room < ParcelFrame::kOverheadMax) return std::nullopt;
  const std::size_t piece = std::min(gap.end - gap.first, room - ParcelFrame::kOverheadMax);
  if (piece < std::min<std::size_t>(gap.end - gap.first, kPieceMin)) return std::nullopt;

  const NumberRange bytes{gap.first, gap.first + piece};
  begin(parcel);
  parcel.to_send.remove(bytes);
  parcel.asked = false;
  if (parcel.probe == Probe::kReady) parcel.probe = Probe::kSent;
  note_sendable(found);
  oldest_next_ = !oldest_next_;
  counts_.parcel_bytes_sent += piece;
  return fragment(found, bytes);
}

std::optional<OutgoingFrame> ParcelOutbox::again(const FragmentTicket& ticket) const {
  const auto parcel = parcels_.find(ticket.parcel.number);
  if (parcel == parcels_.end() || ticket.parcel.stream != stream_) return std::nullopt;
  if (parcel->second.acked.contains(ticket.bytes)) return std::nullopt;
  return fragment(parcel, ticket.bytes);
}

std::optional<OutgoingFrame> ParcelOutbox::next_question(MeshTime now, std::size_t room) {
  if (questions_.empty() || questions_.begin()->first > now) return std::nullopt;
  if (room < ParcelFrame::kOverheadMax) return std::nullopt;
  const auto parcel = parcels_.find(questions_.begin()->second);
  if (parcel->second.bytes.empty()) begin(parcel->second);
  parcel->second.asked = true;
  const auto stretch = static_cast<int>(1 + questions_.size() / kQuestionsAtOnce);
  ask_at(parcel, now + config_.ask_after * stretch);
  ++counts_.parcel_questions;
  const std::uint64_t end = parcel->second.bytes.size();
  return fragment(parcel, {end, end});
}

MeshTime ParcelOutbox::question_due() const {
  return questions_.empty() ? kNever : questions_.begin()->first;
}

void ParcelOutbox::on_acked(MeshTime now, const FragmentTicket& ticket) {
  const auto parcel = find(ticket.parcel);
  if (parcel == parcels_.end()) return;
  parcel->second.acked.add(ticket.bytes);
  parcel->second.to_send.remove(ticket.bytes);
  note_sendable(parcel);
  if (parcel->second.ask_at == kNever) ask_if_complete(parcel, now + config_.ask_after);
}

void ParcelOutbox::on_lost(MeshTime now, const FragmentTicket& ticket) {
  const auto found = find(ticket.parcel);
  if (found == parcels_.end()) return;
  Parcel& parcel = found->second;
  if (ticket.bytes.first == ticket.bytes.end) {
    if (parcel.asked) ask_at(found, std::min(parcel.ask_at, now));
    return;
  }
  ByteRanges lost = parcel.acked.missing_in(ticket.bytes);
  counts_.parcel_bytes_repeated += lost.size();
  for (const NumberRange& range : lost.ranges()) parcel.to_send.add(range);
  if (parcel.probe == Probe::kSent && !lost.empty()) parcel.probe = Probe::kReady;
  note_sendable(found);
}

std::optional<ParcelKey> ParcelOutbox::on_state(MeshTime now, const ParcelStateFrame& state) {
  const auto found = find(state.parcel);
  if (found == parcels_.end()) {
    ++counts_.states_unknown;
    return std::nullopt;
  }
  Parcel& parcel = found->second;
  if (!state.have.empty() && state.have.back().end > parcel.bytes.size()) {
    ++counts_.states_malformed;
    return std::nullopt;
  }
  if (state.finished) {
    finish(found);
    return state.parcel;
  }
  if (parcel.asked) drop_from_acked(parcel, state);
  if (!state.have.empty()) parcel.probe = Probe::kNone;
  for (const NumberRange& range : state.have) {
    parcel.acked.add(range);
    parcel.to_send.remove(range);
  }
  parcel.asked = false;
  note_sendable(found);
  ask_at(found, kNever);
  ask_if_complete(found, now + config_.ask_after);
  return std::nullopt;
}

// What we thought arrived and the answer to our question does not name was dropped there. A full
// list may go on beyond its end.
void ParcelOutbox::drop_from_acked(Parcel& parcel, const ParcelStateFrame& state) {
  const bool full = state.have.size() == ParcelStateFrame::kRangesMax;
  ByteRanges dropped = parcel.acked;
  for (const NumberRange& range : state.have) dropped.remove(range);
  if (full) dropped.remove({state.have.back().end, parcel.bytes.size()});
  for (const NumberRange& range : dropped.ranges()) {
    parcel.acked.remove(range);
    parcel.to_send.add(range);
  }
  counts_.parcel_bytes_repeated += dropped.size();
  if (!dropped.empty()) parcel.probe = Probe::kReady;
}

void ParcelOutbox::on_peer_restarted() {
  begun_bytes_ = 0;
  for (auto parcel = parcels_.begin(); parcel != parcels_.end(); ++parcel) {
    Parcel& state = parcel->second;
    counts_.parcel_bytes_repeated += state.acked.size();
    state.acked.clear();
    state.to_send.add(all_of(state.bytes));
    state.begun = false;
    state.asked = false;
    state.probe = Probe::kNone;
    note_sendable(parcel);
    ask_at(parcel, kNever);
    ask_if_complete(parcel, MeshTime::min());
  }
}

SavedOutgoing ParcelOutbox::save() const {
  SavedOutgoing saved{stream_, next_number_, {}};
  saved.parcels.reserve(parcels_.size());
  for (const auto& [number, parcel] : parcels_)
    saved.parcels.push_back({number, parcel.priority, parcel.bytes});
  return saved;
}

void ParcelOutbox::restore(SavedOutgoing saved) {
  assert(parcels_.empty() && next_number_ == 0);
  stream_ = saved.stream;
  next_number_ = saved.next_number + std::min(kNumbersPerSave, kNumberEnd - saved.next_number);
  for (SavedOutgoing::Parcel& parcel : saved.parcels) {
    budget_.take_anyway(ParcelBudget::charge(parcel.bytes.size()));
    add(parcel.number, parcel.priority, std::move(parcel.bytes));
  }
}

ParcelOutbox::Parcels::iterator ParcelOutbox::find(const ParcelKey& key) {
  return key.stream == stream_ ? parcels_.find(key.number) : parcels_.end();
}

std::optional<std::uint32_t> ParcelOutbox::choose(ParcelClass priority) const {
  struct Choice {
    std::uint64_t rank = 0;
    std::uint32_t number = 0;
  };
  std::optional<Choice> best;
  const auto look_at = [&](const std::set<std::uint32_t>& numbers) {
    std::size_t looked_at = 0;
    for (const std::uint32_t number : numbers) {
      if (++looked_at > kLookedAt) return;
      const Parcel& parcel = parcels_.at(number);
      if (!parcel.begun && !may_begin(parcel)) continue;
      const std::uint64_t rank = oldest_next_ ? number : parcel.to_send.size();
      if (!best || rank < best->rank) best = {rank, number};
      if (oldest_next_) return;
    }
  };
  const Sendable& sendable = sendable_[static_cast<std::size_t>(priority)];
  look_at(sendable.begun);
  look_at(sendable.untouched);
  return best ? std::optional(best->number) : std::nullopt;
}

// The receiver holds no more than its limit, and of the message class a parcel less.
bool ParcelOutbox::may_begin(const Parcel& parcel) const {
  if (begun_bytes_ == 0) return true;
  const std::size_t kept_free =
      parcel.priority == ParcelClass::kControl ? 0 : ParcelBudget::charge(ParcelFrame::kBytesMax);
  return begun_bytes_ + ParcelBudget::charge(parcel.bytes.size()) + kept_free <=
         config_.received_bytes_max;
}

void ParcelOutbox::begin(Parcel& parcel) {
  if (!parcel.begun) begun_bytes_ += ParcelBudget::charge(parcel.bytes.size());
  parcel.begun = true;
}

OutgoingFrame ParcelOutbox::fragment(Parcels::const_iterator parcel, NumberRange bytes) const {
  ParcelFrame frame;
  frame.parcel = {stream_, parcel->first};
  frame.priority = parcel->second.priority;
  frame.finished_before = parcels_.begin()->first;
  frame.total = static_cast<std::uint32_t>(parcel->second.bytes.size());
  frame.offset = static_cast<std::uint32_t>(bytes.first);
  const auto piece = std::span(parcel->second.bytes).subspan(bytes.first, bytes.end - bytes.first);
  frame.bytes.assign(piece.begin(), piece.end());
  const FragmentTicket ticket{frame.parcel, bytes};
  return {std::move(frame), ticket};
}

void ParcelOutbox::ask_at(Parcels::iterator parcel, MeshTime when) {
  questions_.erase({parcel->second.ask_at, parcel->first});
  parcel->second.ask_at = when;
  if (when != kNever) questions_.emplace(when, parcel->first);
}

void ParcelOutbox::ask_if_complete(Parcels::iterator parcel, MeshTime when) {
  const bool complete = parcel->second.acked.contains(all_of(parcel->second.bytes));
  if (complete || parcel->second.probe == Probe::kSent) ask_at(parcel, when);
}

void ParcelOutbox::note_sendable(Parcels::const_iterator parcel) {
  const Parcel& state = parcel->second;
  Sendable& sendable = sendable_[static_cast<std::size_t>(state.priority)];
  sendable.begun.erase(parcel->first);
  sendable.untouched.erase(parcel->first);
  if (state.to_send.empty() || state.probe == Probe::kSent) return;
  (state.begun ? sendable.begun : sendable.untouched).insert(parcel->first);
}

void ParcelOutbox::finish(Parcels::iterator parcel) {
  const std::size_t charge = ParcelBudget::charge(parcel->second.bytes.size());
  if (parcel->second.begun) begun_bytes_ -= charge;
  bytes_ -= charge;
  budget_.give_back(charge);
  ask_at(parcel, kNever);
  parcel->second.to_send.clear();
  note_sendable(parcel);
  parcels_.erase(parcel);
  ++counts_.parcels_delivered;
}

}  // namespace warren::mesh
