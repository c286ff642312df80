// SPDX-License-Identifier: Apache-2.0
#include "tools/world/surface_nets.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <unordered_map>

namespace warren::world {
namespace {

constexpr int kBlock = 8;             // cells along a side
constexpr int kCorners = kBlock + 1;  // samples along a side
constexpr std::uint16_t kNoVertex = 0xFFFF;
using Cell = Eigen::Vector3i;

// Sorts and hashes block coordinates: 21 bits each.
std::uint64_t key_of(const Cell& block) {
  constexpr std::int64_t kOffset = 1 << 20;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key = (key << 21) | static_cast<std::uint64_t>(block[axis] + kOffset);
  return key;
}

// An edge of the grid whose ends differ: from a corner along an axis.
struct Crossing {
  std::uint16_t corner;
  std::uint8_t axis;
  bool starts_in_rock;
};

struct Block {
  Cell first_cell;
  std::uint32_t first_vertex = 0;
  std::array<std::uint16_t, kBlock * kBlock * kBlock> vertex_of_cell;
  std::vector<Crossing> crossings;
};

int cell_index(const Cell& cell) { return (cell.z() * kBlock + cell.y()) * kBlock + cell.x(); }
std::size_t corner_index(const Cell& corner) {
  return static_cast<std::size_t>((corner.z() * kCorners + corner.y()) * kCorners + corner.x());
}

class Mesher {
 public:
  Mesher(const SurfaceField& field, double cell_m) : field_(field), cell_m_(cell_m) {}

  TriangleMesh mesh(const std::vector<Eigen::AlignedBox3d>& boxes) {
    for (const Cell& block : blocks_near(boxes))
      if (may_cross(block)) visit(block);
    // A field is seldom so tame that may_cross() never errs: follow the surface wherever it leads.
    while (!to_follow_.empty()) {
      const Cell block = to_follow_.back();
      to_follow_.pop_back();
      visit(block);
    }
    for (const Block& block : blocks_)
      for (const Crossing& crossing : block.crossings) add_quad(block, crossing);
    mesh_.surfaces.assign(mesh_.triangles.size(), Surface::kRock);
    return std::move(mesh_);
  }

 private:
  std::vector<Cell> blocks_near(const std::vector<Eigen::AlignedBox3d>& boxes) const;
  bool may_cross(const Cell& block) const;
  void visit(const Cell& block);
  bool sample(const Cell& first_cell);
  bool crosses_face(int axis, int layer) const;
  void add_vertices(Block& block);
  void find_crossings(Block& block) const;
  void add_quad(const Block& block, const Crossing& crossing);
  std::uint32_t vertex_at(const Cell& cell) const;

  const SurfaceField& field_;
  double cell_m_;
  std::array<double, kCorners * kCorners * kCorners> samples_{};
  std::vector<Cell> to_follow_;
  std::vector<Block> blocks_;
  std::unordered_map<std::uint64_t, std::size_t> block_at_;
  TriangleMesh mesh_;
};

std::vector<Cell> Mesher::blocks_near(const std::vector<Eigen::AlignedBox3d>& boxes) const {
  std::vector<Cell> blocks;
  for (const Eigen::AlignedBox3d& extent : boxes) {
    const double side_m = cell_m_ * kBlock;
    const Cell low = (extent.min() / side_m).array().floor().cast<int>();
    const Cell high = (extent.max() / side_m).array().floor().cast<int>();
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) blocks.emplace_back(x, y, z);
  }
  const auto before = [](const Cell& a, const Cell& b) { return key_of(a) < key_of(b); };
  std::sort(blocks.begin(), blocks.end(), before);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

bool Mesher::may_cross(const Cell& block) const {
  const double half_m = cell_m_ * kBlock / 2.0;
  const Eigen::Vector3d centre =
      (block * kBlock).cast<double>() * cell_m_ + Eigen::Vector3d::Constant(half_m);
  return field_.may_cross(centre, half_m * std::sqrt(3.0));
}

void Mesher::visit(const Cell& block) {
  if (block_at_.contains(key_of(block))) return;
  const Cell first_cell = block * kBlock;
  if (!sample(first_cell)) return;
  block_at_.emplace(key_of(block), blocks_.size());
  for (int axis = 0; axis < 3; ++axis) {
    if (crosses_face(axis, 0)) to_follow_.push_back(block - Cell::Unit(axis));
    if (crosses_face(axis, kBlock)) to_follow_.push_back(block + Cell::Unit(axis));
  }
  Block& added = blocks_.emplace_back();
  added.first_cell = first_cell;
  add_vertices(added);
  find_crossings(added);
}

// Whether both signs occur.
bool Mesher::sample(const Cell& first_cell) {
  bool has_air = false;
  bool has_rock = false;
  std::size_t i = 0;
  for (int z = 0; z < kCorners; ++z) {
    for (int y = 0; y < kCorners; ++y) {
      for (int x = 0; x < kCorners; ++x) {
        const Cell corner = first_cell + Cell(x, y, z);
        samples_[i] = field_.value(corner.cast<double>() * cell_m_);
        (samples_[i] < 0.0 ? has_air : has_rock) = true;
        ++i;
      }
    }
  }
  return has_air && has_rock;
}

// Whether both signs occur on a face of the block just sampled.
bool Mesher::crosses_face(int axis, int layer) const {
  bool has_air = false;
  bool has_rock = false;
  for (int i = 0; i < kCorners * kCorners; ++i) {
    Cell corner;
    corner[axis] = layer;
    corner[(axis + 1) % 3] = i % kCorners;
    corner[(axis + 2) % 3] = i / kCorners;
    (samples_[corner_index(corner)] < 0.0 ? has_air : has_rock) = true;
  }
  return has_air && has_rock;
}

// The mean of the crossings on a cell's twelve edges, in cells from its first corner; none if the
// cell is all air or all rock.
class CrossingMean {
 public:
  void add_edge(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double a, double b) {
    if ((a < 0.0) == (b < 0.0)) return;
    sum_ += from + (to - from) * (a / (a - b));
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  Eigen::Vector3d mean() const { return sum_ / count_; }

 private:
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  int count_ = 0;
};

void Mesher::add_vertices(Block& block) {
  block.vertex_of_cell.fill(kNoVertex);
  block.first_vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (int i = 0; i < kBlock * kBlock * kBlock; ++i) {
    const Cell cell(i % kBlock, i / kBlock % kBlock, i / (kBlock * kBlock));
    std::array<double, 8> value;
    unsigned in_air = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Cell offset(corner & 1, corner >> 1 & 1, corner >> 2);
      value[static_cast<std::size_t>(corner)] = samples_[corner_index(cell + offset)];
      in_air += value[static_cast<std::size_t>(corner)] < 0.0 ? 1U : 0U;
    }
    if (in_air == 0 || in_air == 8) continue;
    CrossingMean crossings;
    for (int from = 0; from < 8; ++from) {
      for (int axis = 0; axis < 3; ++axis) {
        const int to = from | 1 << axis;
        if (to == from) continue;
        crossings.add_edge(Eigen::Vector3d(from & 1, from >> 1 & 1, from >> 2),
                           Eigen::Vector3d(to & 1, to >> 1 & 1, to >> 2),
                           value[static_cast<std::size_t>(from)],
                           value[static_cast<std::size_t>(to)]);
      }
    }
    block.vertex_of_cell[static_cast<std::size_t>(cell_index(cell))] =
        static_cast<std::uint16_t>(mesh_.vertices.size() - block.first_vertex);
    const Cell whole = block.first_cell + cell;
    mesh_.vertices.emplace_back(
        ((whole.cast<double>() + crossings.mean()) * cell_m_).cast<float>());
  }
}

void Mesher::find_crossings(Block& block) const {
  for (int i = 0; i < kBlock * kBlock * kBlock; ++i) {
    const Cell corner(i % kBlock, i / kBlock % kBlock, i / (kBlock * kBlock));
    const bool starts_in_rock = samples_[corner_index(corner)] >= 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const bool ends_in_rock = samples_[corner_index(corner + Cell::Unit(axis))] >= 0.0;
      if (starts_in_rock == ends_in_rock) continue;
      block.crossings.push_back(
          {static_cast<std::uint16_t>(i), static_cast<std::uint8_t>(axis), starts_in_rock});
    }
  }
}

std::uint32_t Mesher::vertex_at(const Cell& cell) const {
  const Cell block = (cell.cast<double>() / kBlock).array().floor().cast<int>();
  const auto found = block_at_.find(key_of(block));
  assert(found != block_at_.end());
  const Block& there = blocks_[found->second];
  const int index = cell_index(cell - there.first_cell);
  const std::uint16_t vertex = there.vertex_of_cell[static_cast<std::size_t>(index)];
  assert(vertex != kNoVertex);
  return there.first_vertex + vertex;
}

// The four cells around an edge, joined: facing the edge's end in the air.
void Mesher::add_quad(const Block& block, const Crossing& crossing) {
  const int i = crossing.corner;
  const Cell corner =
      block.first_cell + Cell(i % kBlock, i / kBlock % kBlock, i / (kBlock * kBlock));
  const Cell u = Cell::Unit((crossing.axis + 1) % 3);
  const Cell v = Cell::Unit((crossing.axis + 2) % 3);
  std::array<std::uint32_t, 4> q = {vertex_at(corner - u - v), vertex_at(corner - v),
                                    vertex_at(corner), vertex_at(corner - u)};
  if (!crossing.starts_in_rock) std::swap(q[1], q[3]);
  const auto length = [this, &q](std::size_t a, std::size_t b) {
    return (mesh_.vertices[q[a]] - mesh_.vertices[q[b]]).squaredNorm();
  };
  // The shorter diagonal follows the surface better.
  if (length(0, 2) <= length(1, 3)) {
    mesh_.triangles.push_back({q[0], q[1], q[2]});
    mesh_.triangles.push_back({q[0], q[2], q[3]});
  } else {
    mesh_.triangles.push_back({q[0], q[1], q[3]});
    mesh_.triangles.push_back({q[1], q[2], q[3]});
  }
}

}  // namespace

TriangleMesh surface_nets(const SurfaceField& field, const std::vector<Eigen::AlignedBox3d>& boxes,
                          double cell_m) {
  return Mesher(field, cell_m).mesh(boxes);
}

}  // namespace warren::world
