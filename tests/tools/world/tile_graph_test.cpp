// SPDX-License-Identifier: Apache-2.0
#include "tools/world/tile_graph.hpp"

#include <cmath>
#include <cstring>
#include <numbers>
#include <sstream>

#include <doctest/doctest.h>

#include "tests/support/recorded_data.hpp"
#include "tools/world/radio_trace.hpp"
#include "tools/world/subt_tiles.hpp"

using namespace warren::world;

namespace {

// Nodes 2 m apart along a line given by the turn at every node.
PassageGraph gallery(int nodes, double turn_rad) {
  PassageGraph graph;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int i = 0; i < nodes; ++i) {
    const auto node = graph.add_node({position});
    if (i > 0) graph.add_edge(node - 1, node);
    position += 2.0 * Eigen::Vector3d(std::cos(turn_rad * i), std::sin(turn_rad * i), 0.0);
  }
  return graph;
}

std::string cell(std::int32_t x, std::int32_t y, std::int32_t z, std::uint64_t tile) {
  std::string bytes(20, '\0');
  std::memcpy(bytes.data(), &x, 4);
  std::memcpy(bytes.data() + 4, &y, 4);
  std::memcpy(bytes.data() + 8, &z, 4);
  std::memcpy(bytes.data() + 12, &tile, 8);
  return bytes;
}

std::string table(std::uint64_t count, const std::string& cells) {
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &count, 8);
  return bytes + cells;
}

const char* const kDot =
    "/* a -- comment */\ngraph {\n  0 [label=\"0::x::y\"];\n  0 -- 1 [label=1];\n"
    "  1 -- 2 [label=3];\n  0 -- 2 [label=6];\n}\n";

}  // namespace

TEST_CASE("costs are those of the cheapest way") {
  TileGraph graph(4);
  graph.add_edge(0, 1, 1.0);
  graph.add_edge(1, 2, 1.0);
  graph.add_edge(0, 2, 5.0);
  CHECK(graph.costs_from(0) == std::vector<double>{0.0, 1.0, 2.0, INFINITY});
  CHECK(graph.costs_from(2) == std::vector<double>{2.0, 1.0, 0.0, INFINITY});
}

TEST_CASE("a straight gallery costs one for every twenty metres") {
  const PassageGraph graph = gallery(101, 0.0);
  const RadioTiles tiles = passage_tiles(graph);
  CHECK(tiles.cost({0.0, 0.0, 0.5}, {18.0, 0.0, 0.5}) == 0.0);
  CHECK(tiles.cost({0.0, 0.0, 0.0}, {200.0, 0.0, 0.0}) == 10.0);
}

TEST_CASE("a winding gallery costs more than a straight one, by the angle that it turns") {
  const double turn = std::numbers::pi / 10.0;  // a right angle every 10 m
  const PassageGraph graph = gallery(31, turn);
  const RadioTiles tiles = passage_tiles(graph);
  const double cost = tiles.cost(graph.nodes.front().position, graph.nodes[9].position);
  CHECK(cost >= 2.0);
  CHECK(cost <= 4.0);
}

TEST_CASE("a junction costs one more, and radio goes down a shaft that nobody walks") {
  PassageGraph graph = gallery(21, 0.0);
  const double straight = passage_tiles(graph).cost({0.0, 0.0, 0.0}, {16.0, 0.0, 0.0});
  const auto bottom = graph.add_node({Eigen::Vector3d(10.0, 0.0, -2.0)});
  graph.add_edge(5, bottom, false);
  const RadioTiles tiles = passage_tiles(graph);
  CHECK(tiles.cost({0.0, 0.0, 0.0}, {16.0, 0.0, 0.0}) == straight + 2.0);
  CHECK(std::isfinite(tiles.cost({0.0, 0.0, 0.0}, {10.0, 0.0, -2.0})));
}

TEST_CASE("a SubT graph is read, and costs looked up by the metre") {
  const auto tiles =
      parse_subt_tiles(kDot, table(3, cell(0, 0, 0, 0) + cell(10, -3, 1, 1) + cell(20, 0, 0, 2)));
  REQUIRE(tiles);
  CHECK(tiles->size() == 3);
  CHECK(tiles->tile_at({9.6, -3.4, 1.4}) == 1U);
  CHECK_FALSE(tiles->tile_at({5.0, 0.0, 0.0}));
  CHECK(tiles->cost({0.0, 0.0, 0.0}, {20.0, 0.0, 0.0}) == 4.0);
  CHECK(std::isinf(tiles->cost({0.0, 0.0, 0.0}, {5.0, 0.0, 0.0})));
  CHECK_FALSE(tiles->tile_at({NAN, 0.0, 0.0}));
}

TEST_CASE("broken SubT graphs are refused with a reason") {
  const std::string good = table(1, cell(0, 0, 0, 0));
  CHECK_FALSE(parse_subt_tiles("graph {}", good));
  CHECK(parse_subt_tiles("0 -- x [label=1];", good).error() == "line 1: not an edge");
  CHECK_FALSE(parse_subt_tiles("0 -- 1 [label=-1];", good));
  CHECK_FALSE(parse_subt_tiles("0 -- 999999 [label=1];", good));
  CHECK_FALSE(parse_subt_tiles(kDot, table(2, cell(0, 0, 0, 0))));
  CHECK_FALSE(parse_subt_tiles(kDot, table(1, cell(0, 0, 0, 1U << 30U))));
  for (std::size_t length = 0; length < good.size(); ++length)
    CHECK_FALSE(parse_subt_tiles(kDot, good.substr(0, length)));
}

TEST_CASE("simple_tunnel_01 of SubT: one tile after the other, to the 31st") {
  const auto dot = warren::test::recorded_file("subt/simple_tunnel_01.dot");
  if (!dot) return;
  const auto tiles =
      read_subt_tiles(*dot, std::filesystem::path(*dot).replace_extension(".dat")).value();
  CHECK(tiles.size() == 32);
  CHECK(tiles.tile_at({0.0, 0.0, 0.0}) == 0U);
  // A straight tunnel: our own way to cut passages must come to about the same.
  const RadioTiles ours = passage_tiles(gallery(316, 0.0));
  for (int step = 3; step <= 125; ++step) {
    const double x = 5.0 * step;
    const double theirs = tiles.cost(Eigen::Vector3d::Zero(), {x, 0.0, 1.0});
    CHECK(theirs == std::ceil((x - 10.4) / 20.0));
    CHECK(std::abs(ours.cost(Eigen::Vector3d::Zero(), {x, 0.0, 1.0}) - theirs) <= 1.0);
  }
}

TEST_CASE("a trace tells for every time who hears whom, both ways alike, the same every time") {
  const PassageGraph graph = gallery(201, 0.0);
  const RadioTiles tiles = passage_tiles(graph);
  const std::vector<RadioNode> nodes{
      {"base", [](double) { return Eigen::Vector3d::Zero().eval(); }},
      {"one", [](double t) { return Eigen::Vector3d(t, 0.0, 0.0); }}};
  const RadioTrace trace{.end_s = 300.0, .step_s = 10.0};
  std::ostringstream out;
  std::ostringstream again;
  write_radio_trace(out, nodes, tiles, {}, trace);
  write_radio_trace(again, nodes, tiles, {}, trace);
  CHECK(out.str() == again.str());
  std::istringstream in(out.str());
  std::string line;
  std::getline(in, line);
  CHECK(line == "time_s,from,to,loss,rate_bit_s");
  std::vector<std::string> there;
  std::vector<std::string> back;
  while (std::getline(in, line))
    (line.find(",base,one,") != std::string::npos ? there : back).push_back(line);
  REQUIRE(there.size() == 31);
  REQUIRE(back.size() == 31);
  for (std::size_t i = 0; i < there.size(); ++i)
    CHECK(there[i].substr(there[i].find("one,") + 4) == back[i].substr(back[i].find("base,") + 5));
  CHECK(there.front() == "0.000,base,one,0.000000,1000000");
  CHECK(there.back() == "300.000,base,one,1.000000,0");
}
