// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/unconfirmed_boots.hpp"

#include <algorithm>

namespace warren::mesh {
namespace {

// A genuine boot that hears us reacts to the first answer, and through heavy loss to one of eight.
Duration answer_interval(int answers) {
  if (answers < 8) return Duration{};
  return answers < 16 ? std::chrono::seconds(1) : std::chrono::seconds(5);
}

}  // namespace

bool UnconfirmedBoots::may_answer(MeshTime now) {
  if (refilled_ != MeshTime::min()) {
    const std::chrono::duration<double> passed = now - refilled_;
    answers_left_ = std::min(kAnswersAtOnce, answers_left_ + passed.count() * kAnswersPerS);
  }
  refilled_ = now;
  if (answers_left_ < 1.0) return false;
  answers_left_ -= 1.0;
  return true;
}

UnconfirmedBoots::Boot& UnconfirmedBoots::find_or_add(const Boot& boot) {
  const auto known = std::ranges::find(boots_, boot.boot, &Boot::boot);
  if (known != boots_.end()) return *known;
  if (boots_.size() == kMax) boots_.erase(std::ranges::min_element(boots_, {}, &Boot::heard));
  boots_.push_back(boot);
  boots_.back().answer_at = kNever;
  return boots_.back();
}

UnconfirmedBoots::Verdict UnconfirmedBoots::on_beacon(MeshTime now, const Boot& boot) {
  const bool first = std::ranges::find(boots_, boot.boot, &Boot::boot) == boots_.end();
  Boot& known = find_or_add(boot);
  if (!first && boot.number <= known.number) return Verdict::kReplayed;
  known.number = boot.number;
  known.heard = now;
  known.path = boot.path;
  known.member = boot.member;
  const Verdict verdict = first ? Verdict::kFirst : Verdict::kKnown;
  if (known.answer_at != kNever) return verdict;
  if (known.answers > 0 && now - known.answered < answer_interval(known.answers)) return verdict;
  if (!may_answer(now)) return Verdict::kTooMany;
  known.answer_at = boot.answer_at;
  return verdict;
}

void UnconfirmedBoots::challenge(MeshTime now, const Boot& boot) {
  Boot& known = find_or_add(boot);
  known.heard = now;
  known.path = boot.path;
  if (known.answer_at != kNever || !may_answer(now)) return;
  known.answer_at = boot.answer_at;
}

std::optional<UnconfirmedBoots::Boot> UnconfirmedBoots::take_due(MeshTime now) {
  const auto due = std::ranges::min_element(boots_, {}, &Boot::answer_at);
  if (due == boots_.end() || due->answer_at > now) return std::nullopt;
  due->answer_at = kNever;
  due->answered = now;
  ++due->answers;
  return *due;
}

MeshTime UnconfirmedBoots::next() const {
  const auto due = std::ranges::min_element(boots_, {}, &Boot::answer_at);
  return due == boots_.end() ? kNever : due->answer_at;
}

void UnconfirmedBoots::forget(BootId boot) {
  std::erase_if(boots_, [&](const Boot& known) { return known.boot == boot; });
}

}  // namespace warren::mesh
