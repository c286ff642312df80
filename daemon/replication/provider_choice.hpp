// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "daemon/replication/announcement.hpp"

namespace warren::replication {

// A neighbour that is up and holds something of a layer (or log).
struct Candidate {
  MemberId member;
  Hops hops = kNoWay;  // as it says
  bool is_origin = false;
  bool gets_it_here = false;  // it says that we are its provider
  bool leads = false;         // it holds something that we lack and want
  bool is_partial = false;    // of some of what we want it holds nothing
  std::uint32_t highest = 0;
  double rate_bit_s = 0.0;  // of the link
  double loss = 0.0;        // of what it sends us, lately
  bool is_idle = false;     // asked before, and did nothing
  bool is_current = false;
};

struct Choice {
  std::optional<MemberId> provider;
  Hops hops = kNoWay;  // of ours, through it
  friend bool operator==(const Choice&, const Choice&) = default;
};

// Whom to get it from: the origin; else the shortest way to it, where a link at the fringe of reach
// and a copy that is partial count as several; without a way who has more; among equals the better
// link, then the lower number. The present one stays unless another is better by much.
Choice choose_provider(std::span<const Candidate> candidates);

}  // namespace warren::replication
