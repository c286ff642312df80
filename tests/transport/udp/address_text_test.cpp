// SPDX-License-Identifier: Apache-2.0
#include "transport/udp/address_text.hpp"

#include <doctest/doctest.h>

using namespace warren;
using namespace warren::mesh;

TEST_CASE("addresses are read and written the same way") {
  for (const char* text : {"10.9.0.2:7717", "[fe80::1]:1", "[2001:db8::5:6]:65535"}) {
    const auto address = parse_mesh_address(text);
    REQUIRE(address);
    CHECK(to_text(*address) == text);
  }
  CHECK(parse_mesh_address("[::ffff:10.9.0.2]:7717") == parse_mesh_address("10.9.0.2:7717"));
}

TEST_CASE("what is no address is none") {
  for (const char* text : {"", ":", "10.9.0.2", "10.9.0.2:", "10.9.0.2:0", "10.9.0.2:65536",
                           "10.9.0.2:77x", "10.9.0:7717", "fe80::1:7717", "[fe80::1:7717",
                           "[]:7717", "base:7717", "[10.9.0.2]:7717"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_mesh_address(text));
  }
}
