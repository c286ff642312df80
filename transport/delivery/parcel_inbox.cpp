// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/parcel_inbox.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace warren::mesh {
namespace {

constexpr std::size_t kAnswersMax = 1024;

NumberRange one(std::uint32_t number) { return {number, std::uint64_t{number} + 1}; }

// What the flat charge of a parcel does not cover; a vector may have room for twice as many.
std::size_t charge_of(const ByteRanges& have) {
  constexpr std::size_t kCovered = 4;
  const std::size_t ranges = have.ranges().size();
  return ranges > kCovered ? 2 * (ranges - kCovered) * sizeof(NumberRange) : 0;
}

}  // namespace

ParcelInbox::~ParcelInbox() { budget_.give_back(unfinished_bytes()); }

std::optional<ParcelInbox::Arrived> ParcelInbox::on_fragment(const ParcelFrame& fragment) {
  if (fragment.parcel.stream == previous_stream_) {
    ++counts_.old_stream;
    return std::nullopt;
  }
  if (contradicts(fragment)) {
    ++counts_.fragments_malformed;
    return std::nullopt;
  }
  enter_stream(fragment.parcel.stream);
  forget_before(fragment.finished_before);
  const std::uint32_t number = fragment.parcel.number;
  const bool question = fragment.bytes.empty();
  const bool finished = is_finished(number);
  if (finished) ++counts_.fragments_finished;
  if (finished || question) answer(number);
  // The question about an empty parcel is all of it.
  if (finished || (question && fragment.total > 0)) return std::nullopt;

  Parcel* const parcel = admit(fragment);
  if (parcel == nullptr) {
    ++counts_.fragments_refused;
    return std::nullopt;
  }
  return store(fragment, *parcel);
}

// Beyond its total, or against what this parcel's fragments said before.
bool ParcelInbox::contradicts(const ParcelFrame& fragment) const {
  if (fragment.total > ParcelFrame::kBytesMax || fragment.offset > fragment.total) return true;
  if (fragment.bytes.size() > fragment.total - fragment.offset) return true;
  if (fragment.finished_before > fragment.parcel.number) return true;
  if (fragment.parcel.stream != stream_) return false;
  const auto known = parcels_.find(fragment.parcel.number);
  return known != parcels_.end() &&
         (known->second.total != fragment.total || known->second.priority != fragment.priority);
}

// Another stream means that the sender's store was lost: nothing of the old one will come again.
void ParcelInbox::enter_stream(std::uint64_t stream) {
  if (stream_ == stream) return;
  counts_.parcels_forgotten += static_cast<std::uint64_t>(
      std::count_if(parcels_.begin(), parcels_.end(),
                    [](const auto& parcel) { return !parcel.second.handed_on; }));
  while (!parcels_.empty()) release(parcels_.begin());
  previous_stream_ = std::exchange(stream_, stream);
  finished_before_ = 0;
  finished_.clear();
  answers_.clear();
}

void ParcelInbox::forget_before(std::uint32_t number) {
  if (number <= finished_before_) return;
  finished_before_ = number;
  finished_.remove({0, number});
  while (!parcels_.empty() && parcels_.begin()->first < number) {
    if (!parcels_.begin()->second.handed_on) ++counts_.parcels_forgotten;
    release(parcels_.begin());
  }
}

bool ParcelInbox::is_finished(std::uint32_t number) const {
  return number < finished_before_ || finished_.contains(number);
}

// The fragment's parcel, if it is begun already or there is room for it.
ParcelInbox::Parcel* ParcelInbox::admit(const ParcelFrame& fragment) {
  const std::uint32_t number = fragment.parcel.number;
  const auto known = parcels_.find(number);
  if (known != parcels_.end()) return &known->second;
  // Each unfinished one may become a range of its own among the finished.
  if (finished_.ranges().size() + config_.unfinished_max >= SavedIncoming::kRangesMax)
    return nullptr;
  const std::size_t charge = ParcelBudget::charge(fragment.total);
  while (!take_room(charge, fragment.priority)) {
    if (!evict_after(number)) return nullptr;
  }
  Parcel& parcel = parcels_[number];
  parcel.priority = fragment.priority;
  parcel.total = fragment.total;
  parcel.bytes.resize(fragment.total);
  return &parcel;
}

// As the sender counts in ParcelOutbox::may_begin().
bool ParcelInbox::take_room(std::size_t charge, ParcelClass priority) {
  if (parcels_.size() >= config_.unfinished_max) return false;
  const std::size_t kept_free =
      priority == ParcelClass::kControl ? 0 : ParcelBudget::charge(ParcelFrame::kBytesMax);
  if (bytes_ > 0 && bytes_ + charge + kept_free > config_.received_bytes_max) return false;
  if (!budget_.take(charge)) return false;
  bytes_ += charge;
  return true;
}

// Earlier parcels go first: what was begun after this one makes room, the latest first. So one
// parcel at least gets on, whatever earlier lives of the sender have begun here.
bool ParcelInbox::evict_after(std::uint32_t number) {
  for (auto latest = parcels_.end(); latest != parcels_.begin();) {
    --latest;
    if (latest->first < number) return false;
    if (latest->second.handed_on) continue;
    release(latest);
    ++counts_.parcels_evicted;
    return true;
  }
  return false;
}

bool ParcelInbox::charge_ranges(const ByteRanges& before, const ByteRanges& after) {
  const std::size_t old = charge_of(before);
  const std::size_t now = charge_of(after);
  if (now > old) {
    if (range_bytes_ + now - old > kRangeBytesMax || !budget_.take(now - old)) return false;
  } else {
    budget_.give_back(old - now);
  }
  range_bytes_ += now;
  range_bytes_ -= old;
  return true;
}

std::optional<ParcelInbox::Arrived> ParcelInbox::store(const ParcelFrame& fragment,
                                                       Parcel& parcel) {
  const NumberRange range{fragment.offset, fragment.offset + fragment.bytes.size()};
  if (parcel.handed_on || (parcel.total > 0 && parcel.have.contains(range))) {
    ++counts_.fragments_duplicate;
    return std::nullopt;
  }
  ByteRanges have = parcel.have;
  have.add(range);
  if (have.ranges().size() > kRangesPerParcelMax || !charge_ranges(parcel.have, have)) {
    ++counts_.fragments_refused;
    return std::nullopt;
  }
  parcel.have = std::move(have);
  std::copy(fragment.bytes.begin(), fragment.bytes.end(), parcel.bytes.begin() + fragment.offset);
  if (!parcel.have.contains({0, parcel.total})) return std::nullopt;
  parcel.handed_on = true;
  ++counts_.parcels_delivered;
  return Arrived{fragment.parcel, parcel.priority, std::exchange(parcel.bytes, {})};
}

void ParcelInbox::finish(const ParcelKey& key) {
  if (key.stream != stream_ || is_finished(key.number)) return;
  const auto parcel = parcels_.find(key.number);
  if (parcel != parcels_.end()) release(parcel);
  if (finished_.ranges().size() == SavedIncoming::kRangesMax) return;
  finished_.add(one(key.number));
  answer(key.number);
}

std::optional<OutgoingFrame> ParcelInbox::next_answer(std::size_t room) {
  if (answers_.empty()) return std::nullopt;
  const std::uint32_t number = *answers_.begin();
  ParcelStateFrame state{{*stream_, number}, is_finished(number), {}};
  const auto parcel = parcels_.find(number);
  if (parcel != parcels_.end()) {
    const auto have = parcel->second.have.ranges();
    const auto told = have.first(std::min(have.size(), ParcelStateFrame::kRangesMax));
    state.have.assign(told.begin(), told.end());
  }
  const ParcelStateTicket ticket{state.parcel};
  OutgoingFrame frame{std::move(state), ticket};
  if (encoded_bytes(frame.frame) > room) return std::nullopt;
  answers_.erase(answers_.begin());
  return frame;
}

void ParcelInbox::on_lost(const ParcelStateTicket& ticket) {
  const std::uint32_t number = ticket.parcel.number;
  if (ticket.parcel.stream != stream_ || number < finished_before_) return;
  if (parcels_.contains(number) || is_finished(number)) answer(number);
}

void ParcelInbox::on_peer_restarted() {
  for (const auto& [number, parcel] : parcels_) answer(number);
}

void ParcelInbox::drop_partial() {
  for (auto parcel = parcels_.begin(); parcel != parcels_.end();) {
    const auto next = std::next(parcel);
    if (!parcel->second.handed_on) {
      release(parcel);
      ++counts_.parcels_evicted;
    }
    parcel = next;
  }
}

std::size_t ParcelInbox::handed_on() const {
  return static_cast<std::size_t>(std::count_if(
      parcels_.begin(), parcels_.end(), [](const auto& entry) { return entry.second.handed_on; }));
}

SavedIncoming ParcelInbox::save() const {
  SavedIncoming saved;
  saved.previous_stream = previous_stream_;
  if (!stream_) return saved;
  const auto finished = finished_.ranges();
  saved.stream = {*stream_, finished_before_, {finished.begin(), finished.end()}};
  return saved;
}

void ParcelInbox::restore(const SavedIncoming& saved) {
  assert(!stream_ && parcels_.empty());
  previous_stream_ = saved.previous_stream;
  if (!saved.stream) return;
  stream_ = saved.stream->id;
  finished_before_ = saved.stream->finished_before;
  for (const NumberRange& range : saved.stream->finished) finished_.add(range);
}

void ParcelInbox::release(std::map<std::uint32_t, Parcel>::iterator parcel) {
  const std::size_t charge = ParcelBudget::charge(parcel->second.total);
  const std::size_t ranges = charge_of(parcel->second.have);
  bytes_ -= charge;
  range_bytes_ -= ranges;
  budget_.give_back(charge + ranges);
  parcels_.erase(parcel);
}

void ParcelInbox::answer(std::uint32_t number) {
  if (answers_.size() < kAnswersMax || answers_.contains(number)) {
    answers_.insert(number);
  } else {
    ++counts_.answers_dropped;
  }
}

}  // namespace warren::mesh
