// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/tables.hpp"

#include <iomanip>
#include <sstream>

#include <google/protobuf/util/json_util.h>

#include "warren/control.pb.h"

namespace warren {
namespace {

constexpr int kLabelWidth = 20;
constexpr int kColumnWidth = 14;
constexpr double kBytesPerMegabyte = 1e6;

using Numbers = google::protobuf::RepeatedField<double>;
using Counts = google::protobuf::RepeatedPtrField<control::Count>;

std::ostream& label(std::ostream& out, const std::string& text) {
  return out << std::left << std::setw(kLabelWidth) << text << std::right;
}

std::string listed(const Numbers& numbers, int decimals) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(decimals);
  for (int i = 0; i < numbers.size(); ++i) out << (i == 0 ? "" : ", ") << numbers[i];
  return numbers.empty() ? "-" : out.str();
}

// Only what happened; a line of zeros helps nobody.
std::string listed(const Counts& counts) {
  std::string text;
  for (const auto& count : counts) {
    if (count.count() == 0) continue;
    text.append(text.empty() ? "" : ", ").append(count.name()).append(" ");
    text.append(std::to_string(count.count()));
  }
  return text.empty() ? "none" : text;
}

void add_sensors(std::ostream& out, const control::Status& status) {
  label(out, "sensor");
  for (const char* const head : {"received", "taken", "overload", "out of order", "rejected"}) {
    out << std::setw(kColumnWidth) << head;
  }
  out << "\n";
  for (const auto& sensor : status.sensors()) {
    label(out, "  " + sensor.name());
    for (const auto count : {sensor.received(), sensor.taken(), sensor.dropped_overload(),
                             sensor.dropped_out_of_order(), sensor.rejected()}) {
      out << std::setw(kColumnWidth) << count;
    }
    out << "\n";
  }
}

void add_store(std::ostream& out, const control::Status& status) {
  if (!status.has_store()) {
    label(out, "store") << "none: a restart begins anew\n";
    return;
  }
  const auto& store = status.store();
  label(out, "store") << std::setprecision(1)
                      << static_cast<double>(store.used_bytes()) / kBytesPerMegabyte << " MB, "
                      << store.transactions() << " transactions";
  if (store.layers_evicted() + store.messages_evicted() > 0) {
    out << ", " << store.layers_evicted() << " layers and " << store.messages_evicted()
        << " messages of others dropped to make room";
  }
  out << "\n";
  if (!store.failing().empty())
    label(out, "") << "THE DISK TAKES NOTHING: " << store.failing() << "\n";
}

void add_layers(std::ostream& out, const control::Status& status) {
  const auto& memory = status.layer_memory();
  const auto megabytes = [](std::uint64_t bytes) {
    return static_cast<double>(bytes) / kBytesPerMegabyte;
  };
  label(out, "memory of layers") << std::setprecision(1)
                                 << megabytes(memory.own_layers_bytes() +
                                              memory.loaded_layers_bytes() +
                                              memory.merge_map_bytes())
                                 << " MB: own " << megabytes(memory.own_layers_bytes())
                                 << ", loaded " << megabytes(memory.loaded_layers_bytes())
                                 << ", merge-map " << megabytes(memory.merge_map_bytes()) << "; "
                                 << memory.regions_at_rest() << " of " << memory.regions()
                                 << " regions rest in " << megabytes(memory.at_rest_bytes())
                                 << "\n";
  if (status.poses_refused() > 0) {
    label(out, "poses refused") << status.poses_refused() << "\n";
  }
  label(out, "layers loaded") << status.layers_loaded() << "\n";
  for (const auto& layer : status.loaded()) out << "  " << sentence_of(layer);
}

std::string printed_json(const google::protobuf::Message& message, bool add_whitespace) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  options.add_whitespace = add_whitespace;
  std::string json;
  const auto printed = google::protobuf::util::MessageToJsonString(message, &json, options);
  return printed.ok() ? json : "{}";
}

}  // namespace

std::string table_of(const control::Status& status) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(1);
  label(out, "node") << status.node() << ", warrend " << status.version() << ", up "
                     << status.uptime_s() << " s\n";
  label(out, "clients") << status.clients() << "\n";
  label(out, "queue") << status.queue_scans() << " of " << status.queue_capacity() << " scans\n";
  add_sensors(out, status);
  label(out, "integration") << std::setprecision(2) << status.integrate_cpu_ms_mean()
                            << " ms CPU per scan, at most " << status.integrate_cpu_ms_max()
                            << " ms\n";
  label(out, "points not used") << listed(status.rejected_points()) << "\n";
  label(out, "clients refused") << listed(status.refused_frames()) << "\n";
  if (status.replies_dropped() > 0) {
    label(out, "replies not read") << status.replies_dropped() << "\n";
  }
  const auto& publishing = status.publishing();
  label(out, "published") << publishing.bytes() << " bytes in " << publishing.packets()
                          << " packets, " << publishing.ticks() << " ticks ("
                          << publishing.ticks_late() << " late); revision " << publishing.revision()
                          << ", " << publishing.blocks_held_back()
                          << " blocks hold something back\n";
  add_layers(out, status);
  add_store(out, status);
  return out.str() + table_of(status.map());
}

std::string table_of(const control::MapInfo& info) {
  std::ostringstream out;
  label(out, "resolution") << info.resolution_m() << " m\n";
  if (info.layers() == 0) {
    label(out, "map") << "empty: no scan has been taken\n";
    return out.str();
  }
  label(out, "scans in the map") << info.scans() << "\n";
  label(out, "voxels") << info.voxels_occupied() << " occupied, " << info.voxels_free()
                       << " free\n";
  label(out, "cost of occupied") << info.cost_up_to_0p10() << " up to 0.10, "
                                 << info.cost_up_to_0p20() << " up to 0.20, "
                                 << info.cost_above_0p20() << " above, " << info.cost_no_data()
                                 << " no data\n";
  label(out, "blocks") << info.blocks() << "\n";
  label(out, "memory") << std::fixed << std::setprecision(1)
                       << static_cast<double>(info.memory_bytes()) / kBytesPerMegabyte << " MB\n";
  label(out, "frame epoch") << info.frame_epoch() << " (layer " << info.layers() << ")\n";
  label(out, "origin in map, m") << listed(info.origin_map_m(), 2) << "\n";
  label(out, "known from, m") << listed(info.low_map_m(), 1) << "\n";
  label(out, "known to, m") << listed(info.high_map_m(), 1) << "\n";
  label(out, "map in fleet") << listed(info.t_fleet_map(), 3) << " (x y z m, qx qy qz qw)\n";
  return out.str();
}

std::string table_of(const control::Ground& ground) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(3);
  const auto cost = [&](const char* name, bool known, double value) {
    label(out, name);
    if (known) {
      out << value << "\n";
    } else {
      out << "no data\n";
    }
  };
  label(out, "validity") << ground.validity() << "\n";
  cost("mean cost", ground.has_mean_cost(), ground.mean_cost());
  cost("max cost", ground.has_max_cost(), ground.max_cost());
  label(out, "unknown") << ground.unknown_share() << " of the footprint\n";
  label(out, "stairs") << ground.stairs_share() << " of the footprint\n";
  label(out, "step") << ground.step_m() << " m\n";
  label(out, "columns") << ground.columns() << ", " << ground.columns_with_ground()
                        << " with ground, " << ground.columns_with_cost() << " with a cost\n";
  return out.str();
}

std::string sentence_of(const control::MapSaved& saved) {
  std::ostringstream out;
  out << saved.path() << ": " << saved.voxels() << " voxels, " << saved.bytes() << " bytes";
  if (!saved.note().empty()) out << " (" << saved.note() << ")";
  out << "\n";
  return out.str();
}

std::string table_of(const control::Cells& cells) {
  std::ostringstream out;
  out << std::fixed;
  int unknown = 0;
  for (const auto& cell : cells.cells()) {
    if (cell.state() == "unknown" && !cell.mixed()) {
      ++unknown;
      continue;
    }
    label(out, listed(cell.low_map_m(), 2)) << "  " << cell.state();
    if (cell.has_cost()) out << std::setprecision(2) << ", cost " << cell.cost();
    if (cell.state() == "occupied" && !cell.has_cost()) out << ", cost no data";
    if (cell.stair()) out << ", stair";
    if (cell.mixed()) out << ", at worst: its voxels differ";
    out << "\n";
  }
  out << cells.cells_size() << (cells.cells_size() == 1 ? " cell of " : " cells of ")
      << std::setprecision(3) << cells.cell_m() << " m, " << unknown << " unknown throughout\n";
  return out.str();
}

std::string text_of(const control::LayerId& id) {
  std::ostringstream out;
  out << id.origin() << "." << id.number() << "." << std::hex << std::setfill('0') << std::setw(16)
      << id.incarnation();
  return out.str();
}

std::string sentence_of(const control::LoadedLayer& layer) {
  std::ostringstream out;
  out << text_of(layer.layer())
      << (layer.file().empty() ? std::string(", a copy") : " of " + layer.file()) << ": "
      << layer.voxels_occupied() << " occupied and " << layer.voxels_free() << " free voxels of "
      << layer.resolution_m() << " m, ";
  if (layer.retracted()) {
    out << "retracted";
  } else if (layer.unplaced()) {
    out << "and where it lies is not known yet";
  } else {
    out << (layer.out_of_reach() ? "too far off for the merge-map" : "in the merge-map");
  }
  out << "; its origin in the fleet frame: " << listed(layer.t_fleet_layer(), 3)
      << " (x y z m, qx qy qz qw)\n";
  return out.str();
}

std::string sentence_of(const control::LayerFlushed& flushed) {
  std::ostringstream out;
  out << flushed.blocks() << " blocks were held back and are published now; revision "
      << flushed.revision() << "\n";
  return out.str();
}

std::string json_of(const google::protobuf::Message& message) {
  return printed_json(message, true);
}

std::string json_line_of(const google::protobuf::Message& message) {
  return printed_json(message, false) + "\n";
}

}  // namespace warren
