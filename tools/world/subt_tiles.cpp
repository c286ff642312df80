// SPDX-License-Identifier: Apache-2.0
#include "tools/world/subt_tiles.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include "core/exchange/file_bytes.hpp"
#include "tools/world/number_text.hpp"

namespace warren::world {
namespace {

static_assert(std::endian::native == std::endian::little, "the file format is little endian");

constexpr std::uint32_t kMaxTiles = 10'000;
constexpr std::size_t kCellBytes = 20;
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 28;

using Cell = std::array<std::int32_t, 3>;
using Cells = std::map<Cell, TileGraph::Tile>;

struct DotEdge {
  TileGraph::Tile from = 0;
  TileGraph::Tile to = 0;
  double cost = 0.0;
};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

template <class Number>
std::optional<Number> number_of(std::string_view text) {
  return number_in<Number>(trimmed(text));
}

// `A -- B [label=COST];`
std::optional<DotEdge> edge_of(std::string_view line) {
  constexpr std::string_view kLabel = "[label=";
  const auto dashes = line.find("--");
  const auto label = line.find(kLabel);
  const auto close = line.find(']');
  if (label == std::string_view::npos || close == std::string_view::npos || label > close)
    return std::nullopt;
  const auto from = number_of<TileGraph::Tile>(line.substr(0, dashes));
  const auto to = number_of<TileGraph::Tile>(line.substr(dashes + 2, label - dashes - 2));
  const auto cost =
      number_of<double>(line.substr(label + kLabel.size(), close - label - kLabel.size()));
  if (!from || !to || !cost || *from >= kMaxTiles || *to >= kMaxTiles || !(*cost >= 0.0))
    return std::nullopt;
  return DotEdge{*from, *to, *cost};
}

tl::expected<std::vector<DotEdge>, std::string> parse_dot(std::string_view text) {
  std::vector<DotEdge> edges;
  for (std::size_t line_number = 1; !text.empty(); ++line_number) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    const std::string_view line = trimmed(text.substr(0, end + 1));
    text.remove_prefix(end + 1);
    if (line.starts_with("/*") || line.find("--") == std::string_view::npos) continue;
    const auto edge = edge_of(line);
    if (!edge) return tl::unexpected("line " + std::to_string(line_number) + ": not an edge");
    edges.push_back(*edge);
  }
  if (edges.empty()) return tl::unexpected(std::string("the graph has no edges"));
  return edges;
}

tl::expected<Cells, std::string> parse_dat(std::string_view bytes) {
  std::uint64_t count = 0;
  if (bytes.size() < sizeof(count)) return tl::unexpected(std::string("the table has no count"));
  std::memcpy(&count, bytes.data(), sizeof(count));
  bytes.remove_prefix(sizeof(count));
  if (bytes.size() % kCellBytes != 0 || count != bytes.size() / kCellBytes)
    return tl::unexpected(std::string("the table is not as long as its count says"));
  Cells cells;
  for (; !bytes.empty(); bytes.remove_prefix(kCellBytes)) {
    Cell cell{};
    std::uint64_t tile = 0;
    std::memcpy(cell.data(), bytes.data(), sizeof(cell));
    std::memcpy(&tile, bytes.data() + sizeof(cell), sizeof(tile));
    if (tile >= kMaxTiles) return tl::unexpected("no tile " + std::to_string(tile));
    cells[cell] = static_cast<TileGraph::Tile>(tile);
  }
  return cells;
}

std::optional<Cell> cell_at(const Eigen::Vector3d& position) {
  constexpr double kFar = 1e6;
  if (!(position.array().abs() < kFar).all()) return std::nullopt;
  const Eigen::Vector3i cell = position.array().round().cast<int>();
  return Cell{cell.x(), cell.y(), cell.z()};
}

std::size_t tiles_in(const std::vector<DotEdge>& edges, const Cells& cells) {
  TileGraph::Tile last = 0;
  for (const DotEdge& edge : edges) last = std::max({last, edge.from, edge.to});
  for (const auto& [cell, tile] : cells) last = std::max(last, tile);
  return last + 1;
}

}  // namespace

tl::expected<RadioTiles, std::string> parse_subt_tiles(std::string_view dot, std::string_view dat) {
  const auto edges = parse_dot(dot);
  if (!edges) return tl::unexpected(edges.error());
  auto cells = parse_dat(dat);
  if (!cells) return tl::unexpected(cells.error());
  TileGraph graph(tiles_in(*edges, *cells));
  for (const DotEdge& edge : *edges) graph.add_edge(edge.from, edge.to, edge.cost);
  const auto tile_at = [cells = std::move(*cells)](
                           const Eigen::Vector3d& position) -> std::optional<TileGraph::Tile> {
    const auto cell = cell_at(position);
    const auto found = cell ? cells.find(*cell) : cells.end();
    if (found == cells.end()) return std::nullopt;
    return found->second;
  };
  return RadioTiles(graph, tile_at);
}

tl::expected<RadioTiles, std::string> read_subt_tiles(const std::filesystem::path& dot,
                                                      const std::filesystem::path& dat) {
  const auto text = read_file_bytes(dot, kMaxFileBytes);
  if (!text) return tl::unexpected(text.error());
  const auto bytes = read_file_bytes(dat, kMaxFileBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse_subt_tiles(*text, *bytes);
}

}  // namespace warren::world
