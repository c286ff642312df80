// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "core/voxel/scan.hpp"
#include "core/voxel/self_map.hpp"

namespace warren {

// How far two maps agree, voxel by voxel.
struct MapAgreement {
  std::uint64_t free_ours = 0;
  std::uint64_t free_peer = 0;
  std::uint64_t free_both = 0;
  std::uint64_t occupied_ours = 0;
  std::uint64_t occupied_peer = 0;
  std::uint64_t occupied_both = 0;

  // Intersection over union; 1 when both sets are empty.
  double iou_free() const { return iou(free_ours, free_peer, free_both); }
  double iou_occupied() const { return iou(occupied_ours, occupied_peer, occupied_both); }
  bool identical() const {
    return free_ours == free_peer && free_peer == free_both && occupied_ours == occupied_peer &&
           occupied_peer == occupied_both;
  }

 private:
  static double iou(std::uint64_t a, std::uint64_t b, std::uint64_t both) {
    const std::uint64_t either = a + b - both;
    return either == 0 ? 1.0 : static_cast<double>(both) / static_cast<double>(either);
  }
};

// Debian's OctoMap, fed with the same scans: the oracle of the tests and the peer of the
// benchmarks.
class OctomapPeer {
 public:
  explicit OctomapPeer(const SelfMapConfig& config, bool lazy_eval = false);
  ~OctomapPeer();
  OctomapPeer(OctomapPeer&&) noexcept;

  // A cloud in OctoMap's own type, made outside of any timer.
  struct Cloud;
  static std::shared_ptr<const Cloud> make_cloud(const LayerScan& scan);

  void insert(const Cloud& cloud);
  void insert(const LayerScan& scan) { insert(*make_cloud(scan)); }
  // Brings inner nodes up to date and prunes: the part of the work that lazy_eval puts off.
  void finish();

  MapAgreement compare(const SelfMap& ours) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
  bool discretize_;
  bool lazy_eval_;
};

}  // namespace warren
