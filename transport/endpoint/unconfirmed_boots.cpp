// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/unconfirmed_boots.hpp"

#include <algorithm>

namespace warren {

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

bool UnconfirmedBoots::heard(MeshTime now, const Boot& boot) {
  auto known = std::ranges::find(boots_, boot.boot, &Boot::boot);
  if (known == boots_.end()) {
    if (boots_.size() == kMax) boots_.erase(std::ranges::min_element(boots_, {}, &Boot::heard));
    boots_.push_back(boot);
    boots_.back().answer_at = kNever;
    known = boots_.end() - 1;
  }
  known->heard = now;
  known->path = boot.path;
  known->member = boot.member;
  if (known->answer_at != kNever) return true;
  if (!may_answer(now)) return false;
  known->answer_at = boot.answer_at;
  return true;
}

std::optional<UnconfirmedBoots::Boot> UnconfirmedBoots::take_due(MeshTime now) {
  const auto due = std::ranges::min_element(boots_, {}, &Boot::answer_at);
  if (due == boots_.end() || due->answer_at > now) return std::nullopt;
  Boot taken = *due;
  due->answer_at = kNever;
  return taken;
}

MeshTime UnconfirmedBoots::next() const {
  const auto due = std::ranges::min_element(boots_, {}, &Boot::answer_at);
  return due == boots_.end() ? kNever : due->answer_at;
}

void UnconfirmedBoots::forget(BootId boot) {
  std::erase_if(boots_, [&](const Boot& known) { return known.boot == boot; });
}

}  // namespace warren
