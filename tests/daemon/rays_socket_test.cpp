// SPDX-License-Identifier: Apache-2.0
// Rays on the control socket.
#include <cmath>
#include <span>
#include <string>
#include <variant>

#include <doctest/doctest.h>

#include "daemon/control/request.hpp"
#include "tests/daemon/mapped_daemon.hpp"

namespace warren {

TEST_CASE("rays tell what they meet first, and those that make no sense are refused") {
  MappedDaemon daemon;
  TestClient client(daemon.control_socket());
  control::Request request;
  auto& rays = *request.mutable_rays();
  rays.set_max_range_m(10.0);
  for (const double coordinate : {0.55, 0.0, 0.0}) rays.add_origins_map_m(coordinate);
  for (const double coordinate : {2.0, 0.0, 0.0, -1.0, 0.0, 0.0})
    rays.add_directions_map(coordinate);
  for (const auto source : {control::SELF, control::MERGE}) {
    rays.set_source(source);
    const control::Rays ends = client.ask(request).rays();
    REQUIRE(ends.ends_size() == 2);
    CHECK(ends.ends(0).state() == "occupied");
    CHECK(ends.ends(0).range_m() == doctest::Approx(4.45));
    CHECK(ends.ends(0).low_map_m(0) == doctest::Approx(5.0));
    CHECK(ends.ends(1).state() == "unknown");
  }
  rays.set_through_unknown(true);
  CHECK(client.ask(request).rays().ends(1).state() == "free");
  CHECK(client.ask(request).rays().ends(1).low_map_m_size() == 0);

  const auto error = [&] { return client.ask(request).error().text(); };
  rays.set_max_range_m(1e6);
  CHECK(error().find("131072 voxels") != std::string::npos);
  for (const double wrong : {0.0, -1.0, std::nan("")}) {
    rays.set_max_range_m(wrong);
    CHECK(error().find("above 0") != std::string::npos);
  }
  rays.set_max_range_m(1.0);
  rays.set_directions_map(3, 0.0);
  CHECK(error().find("not zero") != std::string::npos);
  rays.set_directions_map(3, std::nan(""));
  CHECK(error().find("not zero") != std::string::npos);
  rays.add_directions_map(1.0);
  CHECK(error().find("3 numbers a ray") != std::string::npos);
  rays.mutable_directions_map()->Resize(3 * 1025, 1.0);
  CHECK(error().find("1024 rays") != std::string::npos);
}

TEST_CASE("a ray's direction becomes one of unit length, whatever its numbers") {
  control::Request request;
  auto& rays = *request.mutable_rays();
  rays.set_max_range_m(10.0);
  rays.mutable_origins_map_m()->Resize(3, 0.0);
  for (const double length : {5e-324, 1e-200, 1.0, 1e200, 1.7e308}) {
    rays.mutable_directions_map()->Clear();
    for (const double share : {1.0, -1.0, 0.0}) rays.add_directions_map(share * length);
    const std::string bytes = request.SerializeAsString();
    const auto decoded = decode_control_request(std::as_bytes(std::span(bytes)));
    REQUIRE(decoded.has_value());
    const Eigen::Vector3d direction = std::get<RaysQuestion>(*decoded).rays.at(0).direction_map;
    CHECK(direction.isApprox(Eigen::Vector3d(std::sqrt(0.5), -std::sqrt(0.5), 0.0), 1e-12));
  }
}

}  // namespace warren
