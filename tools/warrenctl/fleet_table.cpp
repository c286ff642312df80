// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/fleet_table.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <iomanip>
#include <sstream>
#include <utility>
#include <vector>

#include "warren/control.pb.h"

namespace warren {
namespace {

constexpr std::uint32_t kNoWay = 16;  // hops
constexpr std::int64_t kMicrosPerSecond = 1'000'000;

using Row = std::vector<std::string>;

std::string fixed(double number, int decimals) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(decimals) << number;
  return out.str();
}

std::string time_of_day(std::int64_t us) {
  const std::time_t seconds = us / kMicrosPerSecond;
  std::tm local{};
  localtime_r(&seconds, &local);
  std::array<char, 16> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%H:%M:%S", &local)};
}

std::string name_of(const control::FleetNode& node) {
  return node.name().empty() ? std::to_string(node.origin()) : node.name();
}

std::string lag_of(const control::FleetLayer& layer) {
  if (layer.own()) return "-";
  if (layer.lag_revisions() == 0) return "0";
  std::string text = std::to_string(layer.lag_revisions()) + " rev";
  if (layer.has_lag_s()) text += ", " + fixed(layer.lag_s(), 1) + " s";
  return text;
}

std::string kilobytes(std::uint64_t bytes) {
  const double number = static_cast<double>(bytes) * 1e-3;
  return bytes == 0 ? "0" : fixed(number, number < 9.95 ? 1 : 0);
}

// What is new, and what was caught up with.
std::string map_bytes(const control::MapTraffic& traffic) {
  return kilobytes(traffic.fresh_bytes()) + "+" + kilobytes(traffic.backlog_bytes());
}

std::string what_lacks(const control::FleetLayer& layer) {
  std::string text;
  if (!layer.provider().empty()) {
    text = "comes from " + layer.provider();
  } else {
    text = layer.hops() < kNoWay ? "waits" : "nobody here has more";
  }
  if (layer.has_up_to_us()) text += ", up to " + time_of_day(layer.up_to_us());
  if (layer.lag_voxels() > 0) text += ", " + std::to_string(layer.lag_voxels()) + " voxels fewer";
  return text;
}

// What an operator wants to know of the layer, in words.
std::string state_of(const control::FleetNode& node, const control::FleetLayer& layer) {
  if (layer.behind()) return "OTHERS HOLD MORE OF IT than is stored here: restart warrend";
  if (layer.own()) return "is written here";
  std::string text;
  if (layer.lag_revisions() == 0 && layer.latest() > 0) {
    text = "has all of " + name_of(node);
    if (layer.has_within_m()) text += " within " + fixed(layer.within_m(), 0) + " m";
    if (layer.has_up_to_us()) text += " up to " + time_of_day(layer.up_to_us());
    if (layer.has_digest_equal())
      text += layer.digest_equal() ? ", digest equal" : ", DIGEST DIFFERS";
  } else {
    text = what_lacks(layer);
  }
  if (layer.retracted_by_fleet()) text += "; retracted everywhere";
  if (layer.retracted() && !layer.retracted_by_fleet()) text += "; retracted";
  if (layer.out_of_reach()) text += "; too far off for the merge-map";
  if (layer.unplaced()) text += "; where it lies is not known yet";
  if (layer.full()) text += "; no more room for it here";
  if (layer.has_conflict()) text += "; conflict " + fixed(layer.conflict(), 2);
  return text;
}

// Of what comes by others its writer's time counts: it may have been long on its way.
Row unlinked_cells(const control::FleetNode& node) {
  const bool heard = node.has_status_came_s();
  return {heard ? "by others" : "not since start",
          "-",
          "-",
          "-",
          node.has_status_us() ? time_of_day(node.status_us()) : "-",
          "-"};
}

Row link_cells(const control::FleetNode& node) {
  if (node.is_self()) return {"this node", "-", "-", "-", "-", "-"};
  if (!node.has_link()) return unlinked_cells(node);
  const control::FleetLink& link = node.link();
  return {link.up() ? link.interface() : "silent",
          link.has_rtt_ms() ? fixed(link.rtt_ms(), 0) : "-",
          fixed(100.0 * link.loss_out(), 0) + "/" + fixed(100.0 * link.loss_in(), 0),
          link.rate_kbit_s() > 0.0 ? fixed(link.rate_kbit_s(), 0) : "-",
          fixed(link.last_heard_s(), 1) + " s",
          map_bytes(link.received()) + "/" + map_bytes(link.sent())};
}

Row node_cells(const control::FleetNode& node) {
  Row row{name_of(node), node.role().empty() ? "?" : node.role()};
  const Row link = link_cells(node);
  row.insert(row.end(), link.begin(), link.end());
  return row;
}

std::vector<Row> rows_of(const control::FleetStatus& status) {
  std::vector<Row> rows{{"node", "role", "link", "rtt ms", "loss %", "kbit/s", "heard", "kB in/out",
                         "layer", "revision", "lag", "state"}};
  const std::size_t node_columns = 8;
  for (const auto& node : status.nodes()) {
    Row row = node_cells(node);
    for (const auto& layer : node.layers()) {
      row.push_back(std::to_string(layer.layer().number()));
      row.push_back(std::to_string(layer.held_wanted()));
      if (!layer.own()) row.back().append("/").append(std::to_string(layer.latest()));
      row.push_back(lag_of(layer));
      row.push_back(state_of(node, layer));
      rows.push_back(std::exchange(row, Row(node_columns)));
    }
    if (node.layers().empty()) rows.push_back(std::move(row));
  }
  return rows;
}

void print(std::ostream& out, const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool last = i + 1 == row.size();
      out << std::left << std::setw(last ? 0 : static_cast<int>(widths[i] + 2)) << row[i];
    }
    out << "\n";
  }
}

void print_traffic(std::ostream& out, const control::FleetStatus& status) {
  out << "in " << status.ip_bytes_in() << " bytes in " << status.packets_in() << " packets, out "
      << status.ip_bytes_out() << " in " << status.packets_out() << "; of these";
  for (const auto& of : status.sent()) {
    if (of.bytes() > 0) out << " " << of.name() << " " << of.bytes();
  }
  out << "\n";
  if (status.lifetime_size() > 0) out << "over all lives on this store:";
  for (const auto& count : status.lifetime()) out << " " << count.name() << " " << count.count();
  if (status.lifetime_size() > 0) out << "\n";
  for (const auto& interface : status.interfaces()) {
    if (!interface.open())
      out << interface.name() << " is not open: " << interface.problem() << "\n";
  }
  for (const auto* const counts : {&status.unused(), &status.refused()}) {
    std::string text;
    for (const auto& count : *counts) {
      if (count.count() > 0) text += ", " + count.name() + " " + std::to_string(count.count());
    }
    if (text.empty()) continue;
    out << (counts == &status.unused() ? "packets not used: " : "not taken: ") << text.substr(2)
        << "\n";
  }
}

}  // namespace

std::string table_of(const control::FleetStatus& status) {
  if (!status.mesh_on()) return "the mesh is off: the config names no interface\n";
  std::ostringstream out;
  print(out, rows_of(status));
  print_traffic(out, status);
  return out.str();
}

}  // namespace warren
