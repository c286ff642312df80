// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/provider_choice.hpp"

#include <vector>

#include <doctest/doctest.h>

namespace warren::replication {
namespace {

const Candidate kOrigin{.member = {1}, .hops = 0, .is_origin = true};

TEST_CASE("the origin goes first, whatever others hold") {
  const std::vector<Candidate> candidates{
      {.member = {2}, .hops = 1, .leads = true, .highest = 90, .rate_bit_s = 1e7}, kOrigin};
  CHECK(choose_provider(candidates) == Choice{MemberId{1}, 1});
}

TEST_CASE("without the origin the shortest way counts, then who has more, then the better link") {
  std::vector<Candidate> candidates{{.member = {2}, .hops = 2, .leads = true, .highest = 90},
                                    {.member = {3}, .hops = 1, .highest = 5},
                                    {.member = {4}, .hops = 1, .highest = 7, .rate_bit_s = 1e5},
                                    {.member = {5}, .hops = 1, .highest = 7, .rate_bit_s = 1e6}};
  CHECK(choose_provider(candidates) == Choice{MemberId{5}, 2});
  candidates.pop_back();
  CHECK(choose_provider(candidates) == Choice{MemberId{4}, 2});
}

TEST_CASE("who gets it from us is no way to it, but may have what we lack") {
  std::vector<Candidate> candidates{{.member = {2}, .hops = 2, .gets_it_here = true}};
  CHECK(choose_provider(candidates) == Choice{});
  candidates[0].leads = true;
  CHECK(choose_provider(candidates) == Choice{MemberId{2}, kNoWay});
}

TEST_CASE("without a way only who has more is asked") {
  std::vector<Candidate> candidates{{.member = {2}, .highest = 9}};
  CHECK(choose_provider(candidates) == Choice{});
  candidates.push_back({.member = {3}, .leads = true, .highest = 4});
  CHECK(choose_provider(candidates) == Choice{MemberId{3}, kNoWay});
}

TEST_CASE("the present provider stays unless another is better by much") {
  std::vector<Candidate> candidates{{.member = {2}, .hops = 2, .is_current = true},
                                    {.member = {3}, .hops = 1, .rate_bit_s = 1e7}};
  CHECK(choose_provider(candidates).provider == MemberId{2});
  candidates[0].hops = 4;
  CHECK(choose_provider(candidates).provider == MemberId{3});
  candidates[0].hops = 1;
  candidates.push_back(kOrigin);
  CHECK(choose_provider(candidates).provider == MemberId{1});
}

TEST_CASE("a link at the fringe is worth less than a way through another, until it is good again") {
  std::vector<Candidate> candidates{{.member = {2}, .hops = 1, .leads = true}, kOrigin};
  candidates[1].is_current = true;
  candidates[1].loss = 0.5;
  CHECK(choose_provider(candidates).provider == MemberId{1});
  candidates[1].loss = 0.7;
  CHECK(choose_provider(candidates) == Choice{MemberId{2}, 2});
  candidates[1].is_current = false;
  candidates[0].is_current = true;
  candidates[1].loss = 0.5;
  CHECK(choose_provider(candidates).provider == MemberId{2});
  candidates[1].loss = 0.4;
  CHECK(choose_provider(candidates).provider == MemberId{1});
  // Alone it is taken all the same.
  candidates[1].loss = 0.9;
  candidates.erase(candidates.begin());
  CHECK(choose_provider(candidates).provider == MemberId{1});
}

TEST_CASE("who copies a part alone is passed over for a whole copy further away") {
  std::vector<Candidate> candidates{
      {.member = {2}, .hops = 1, .is_partial = true, .is_current = true},
      {.member = {3}, .hops = 2}};
  CHECK(choose_provider(candidates) == Choice{MemberId{3}, 3});
  candidates.pop_back();
  CHECK(choose_provider(candidates) == Choice{MemberId{2}, 2});
}

TEST_CASE("a provider that does nothing is left for another, but kept if it is the only one") {
  std::vector<Candidate> candidates{
      {.member = {2}, .hops = 1, .leads = true, .is_idle = true, .is_current = true},
      {.member = {3}, .hops = 3, .leads = true}};
  CHECK(choose_provider(candidates).provider == MemberId{3});
  candidates.pop_back();
  CHECK(choose_provider(candidates).provider == MemberId{2});
}

TEST_CASE("a way has an end") {
  CHECK(choose_provider(std::vector<Candidate>{{.member = {2}, .hops = kNoWay - 1}}) == Choice{});
}

}  // namespace
}  // namespace warren::replication
