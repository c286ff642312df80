// SPDX-License-Identifier: Apache-2.0
#include "transport/udp/link_state.hpp"

#include <doctest/doctest.h>
#include <sys/resource.h>

namespace warren::mesh {
namespace {

// As if all descriptors were in use.
class NoDescriptors {
 public:
  NoDescriptors() {
    REQUIRE(getrlimit(RLIMIT_NOFILE, &before_) == 0);
    const rlimit none{0, before_.rlim_max};
    REQUIRE(setrlimit(RLIMIT_NOFILE, &none) == 0);
  }
  ~NoDescriptors() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;

 private:
  rlimit before_{};
};

TEST_CASE("an interface that is not there is known not to be") {
  const auto state = read_link_state("nowhere0");
  REQUIRE(state);
  CHECK(state->index == 0);
}

TEST_CASE("an interface that cannot be looked at is not taken for one that is down") {
  REQUIRE(read_link_state("lo"));
  CHECK(read_link_state("lo")->index != 0);
  const NoDescriptors none;
  CHECK_FALSE(read_link_state("lo"));
}

}  // namespace
}  // namespace warren::mesh
