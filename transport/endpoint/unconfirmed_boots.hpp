// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "transport/mesh_address.hpp"
#include "transport/mesh_id.hpp"
#include "transport/mesh_time.hpp"

namespace warren::mesh {

// Boots that only beacons have told of. Whoever recorded the beacons of an earlier life can send
// them again, so they change nothing: each gets an answer now and then that only the genuine boot
// can answer. Bounded in memory and in answers.
class UnconfirmedBoots {
 public:
  static constexpr std::size_t kMax = 64;
  static constexpr double kAnswersPerS = 16.0;
  static constexpr double kAnswersAtOnce = 32.0;

  struct Boot {
    BootId boot;
    MemberId member;  // as it says
    MeshPath path;
    std::uint64_t number = 0;  // of the beacon
    MeshTime heard{};
    MeshTime answer_at = kNever;
    int answers = 0;
    MeshTime answered = MeshTime::min();
  };
  enum class Verdict : std::uint8_t { kFirst, kKnown, kReplayed, kTooMany };

  // A beacon of it came: it is answered at boot.answer_at, unless an answer is due already, or this
  // one brings nothing new, or there were too many answers lately. Who does not react to answers
  // gets fewer.
  Verdict on_beacon(MeshTime now, const Boot& boot);
  // It is answered in any case, as far as the limit for all allows.
  void challenge(MeshTime now, const Boot& boot);
  // The next one to be answered now.
  std::optional<Boot> take_due(MeshTime now);
  MeshTime next() const;
  void forget(BootId boot);
  std::size_t size() const { return boots_.size(); }

 private:
  bool may_answer(MeshTime now);
  Boot& find_or_add(const Boot& boot);

  std::vector<Boot> boots_;
  double answers_left_ = kAnswersAtOnce;
  MeshTime refilled_ = MeshTime::min();
};

}  // namespace warren::mesh
