// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/layer/holdings.hpp"
#include "core/layer/resolution.hpp"
#include "daemon/fleet/node_status.hpp"
#include "daemon/replication/announcement.hpp"
#include "daemon/replication/digest_walk.hpp"
#include "daemon/replication/node_state.hpp"
#include "daemon/replication/peer.hpp"
#include "transport/endpoint/endpoint.hpp"
#include "transport/udp/socket_counts.hpp"

namespace warren {

// A layer as this node has it, beside what is known of it elsewhere.
struct FleetLayerReport {
  LayerId id;
  bool own = false;
  Resolution resolution;
  Revision held_everywhere;                 // the lowest over all keys
  Revision held_somewhere;                  // the highest
  Revision held_wanted;                     // the lowest over the keys that are wanted here
  std::optional<double> within_m;           // these lie so near to this node; nothing: all
  Revision latest;                          // that its writer is known to have made
  std::optional<std::int64_t> up_to_us;     // when held_wanted was made, by its writer's clock
  std::optional<std::int64_t> latest_us;    // the same of `latest`
  std::optional<std::uint64_t> lag_voxels;  // that its writer knew at last and this copy does not
  // Of the content at `latest`: nothing while not all is held, or its writer has not told.
  std::optional<bool> digest_equal;
  std::optional<MemberId> provider;  // whom it comes from
  replication::Hops hops = replication::kNoWay;
  bool retracted = false;
  bool retracted_by_fleet = false;  // by an order of a base
  bool out_of_reach = false;
  bool unplaced = false;
  bool full = false;               // no more room for it here
  bool behind = false;             // an own one: the store is older than what others hold of it
  std::optional<double> conflict;  // share of its obstacles that the own map knows as free

  std::uint32_t lag_revisions() const {
    return latest > held_wanted ? latest.number - held_wanted.number : 0;
  }
  std::optional<double> lag_s() const;
};

struct FleetNodeReport {
  MemberId id;
  std::string name;  // empty: it has not said
  std::optional<NodeRole> role;
  bool is_self = false;
  std::optional<Eigen::Vector3f> position_fleet;
  std::optional<std::int64_t> status_us;  // when it last said something of itself, by its clock
  std::optional<double> status_came_s;    // ago, here; nothing: not since the start
  std::optional<mesh::Member> neighbour;  // who has been heard itself, in this boot of it
  double last_heard_s = 0.0;              // ago; of a neighbour
  std::string interface;
  replication::MapTraffic sent;
  replication::MapTraffic received;
  std::vector<FleetLayerReport> layers;
};

struct FleetInterfaceReport {
  std::string name;
  bool open = false;
  std::string problem;
  mesh::SocketCounts counts;
};

// Of what others said or sent, what was not taken. The names that status gives them tell why.
struct FleetRefusedCounts {
  replication::RefusedCounts replication;
  std::uint64_t layers = 0;                // of them so many are held already
  std::uint64_t packets_without_room = 0;  // for copies that grow no more
  std::uint64_t packets_for_own_layers = 0;
  std::uint64_t logs = 0;                   // so many are held already
  std::uint64_t log_messages = 0;           // announcements and wishes that cannot be used
  std::uint64_t own_items = 0;              // our own log is full
  std::uint64_t items_dropped = 0;          // of others' logs, for want of room
  replication::WalkCounts digests;          // of all layers
  std::uint64_t telemetry = 0;              // by the endpoint
  std::uint64_t copies = 0;                 // by the merge-map
  std::uint64_t unknown_statuses = 0;       // that could not be read
  std::uint64_t statuses_without_room = 0;  // of nodes beyond those that are known
  std::uint64_t messages_unreadable = 0;
  std::uint64_t messages_dropped = 0;     // by the inbox, before anybody fetched them
  std::uint64_t orders_refused = 0;       // that are none, or somebody else's
  std::uint64_t orders_unauthorised = 0;  // of nodes that are no base now
};

struct FleetReport {
  bool mesh_on = false;
  std::vector<FleetNodeReport> nodes;  // this one first, then by name
  std::vector<FleetInterfaceReport> interfaces;
  mesh::EndpointCounts endpoint;
  FleetRefusedCounts refused;
  std::size_t memory_bytes = 0;  // of replication and transport
  std::uint64_t batches_stored = 0;
  std::uint64_t batches_failed = 0;
  bool storing = false;                           // a batch is under way
  std::map<std::string, std::uint64_t> lifetime;  // since the store was made
};

}  // namespace warren
