// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/head_bytes.hpp"

#include <algorithm>
#include <bit>

#include "core/exchange/byte_fields.hpp"

namespace warren {
namespace {

bool read_whole(const ByteReader& reader) { return reader.complete() && reader.left() == 0; }

void write_pose(const Pose& pose, ByteWriter& writer) {
  for (int axis = 0; axis < 3; ++axis) writer.add(pose.translation[axis]);
  for (int part = 0; part < 4; ++part) writer.add(pose.rotation.coeffs()[part]);
}

Pose read_pose(ByteReader& reader) {
  Pose pose;
  for (int axis = 0; axis < 3; ++axis) pose.translation[axis] = reader.real();
  for (int part = 0; part < 4; ++part) pose.rotation.coeffs()[part] = reader.real();
  return pose;
}

void write_written_pose(const WrittenPose& written, ByteWriter& writer) {
  writer.add(written.revision);
  writer.add(written.writer);
  write_pose(written.pose, writer);
}

WrittenPose read_written_pose(ByteReader& reader) {
  WrittenPose written;
  written.revision = reader.number<std::uint32_t>();
  written.writer = reader.number<std::uint32_t>();
  written.pose = read_pose(reader);
  return written;
}

// Never written is as it should be; what was written must be taken again.
bool restore_pose(const WrittenPose& origin, const WrittenPose& correction, LayerPose& pose) {
  const auto taken = [](PoseResult result, const WrittenPose& written) {
    return result == (written.revision == 0 ? PoseResult::kNotWritten : PoseResult::kTaken);
  };
  return taken(pose.update_origin(origin), origin) &&
         taken(pose.update_correction(correction), correction);
}

void write_holdings(const Holdings& holdings, ByteWriter& writer) {
  writer.add(static_cast<std::uint8_t>(holdings.intervals().size()));
  for (const Holdings::Interval& interval : holdings.intervals()) {
    writer.add(interval.first);
    writer.add(interval.held.number);
  }
}

std::optional<Holdings> read_holdings(ByteReader& reader) {
  std::vector<Holdings::Interval> intervals(reader.number<std::uint8_t>());
  for (Holdings::Interval& interval : intervals) {
    interval.first = reader.number<std::uint64_t>();
    interval.held.number = reader.number<std::uint32_t>();
  }
  if (!reader.complete()) return std::nullopt;
  return Holdings::from_intervals(intervals);
}

void write_item_id(const LogItemId& id, ByteWriter& writer) {
  writer.add(id.origin.number);
  writer.add(id.incarnation);
  writer.add(id.sequence);
}

LogItemId read_item_id(ByteReader& reader) {
  LogItemId id;
  id.origin.number = reader.number<std::uint32_t>();
  id.incarnation = reader.number<std::uint64_t>();
  id.sequence = reader.number<std::uint64_t>();
  return id;
}

}  // namespace

Bytes encode_layer_row(const LayerRow& row) {
  ByteWriter writer;
  writer.add(row.head.id.origin);
  writer.add(row.head.id.number);
  writer.add(row.head.id.incarnation);
  writer.add(row.head.resolution.micrometres());
  writer.add(static_cast<std::uint8_t>((row.head.own ? 1 : 0) | (row.closed ? 2 : 0)));
  writer.add(row.written_at);
  write_written_pose(row.head.pose.origin(), writer);
  write_written_pose(row.head.pose.correction(), writer);
  write_holdings(row.head.holdings, writer);
  return writer.take();
}

std::optional<LayerRow> decode_layer_row(ByteView bytes) {
  ByteReader reader(bytes);
  LayerRow row;
  row.head.id.origin = reader.number<std::uint32_t>();
  row.head.id.number = reader.number<std::uint32_t>();
  row.head.id.incarnation = reader.number<std::uint64_t>();
  const auto resolution = Resolution::from_micrometres(reader.number<std::uint32_t>());
  const auto flags = reader.number<std::uint8_t>();
  row.head.own = (flags & 1) != 0;
  row.closed = (flags & 2) != 0;
  row.written_at = reader.number<std::uint64_t>();
  const WrittenPose origin = read_written_pose(reader);
  const WrittenPose correction = read_written_pose(reader);
  const auto holdings = read_holdings(reader);
  if (!holdings || !resolution || !read_whole(reader) || flags > 3) return std::nullopt;
  if (!restore_pose(origin, correction, row.head.pose)) return std::nullopt;
  row.head.resolution = *resolution;
  row.head.holdings = *holdings;
  return row;
}

Bytes encode_self_head(const SelfLayerHead& head) {
  ByteWriter writer;
  writer.add(head.number);
  writer.add(head.frame_epoch);
  for (const std::int64_t axis : {head.origin.x, head.origin.y, head.origin.z}) {
    writer.add(static_cast<std::uint64_t>(axis));
  }
  writer.add(head.config.resolution_m);
  const SensorModel& model = head.config.sensor_model;
  for (const double number : {model.hit, model.miss, model.minimum, model.maximum}) {
    writer.add(number);
  }
  writer.add(static_cast<std::uint8_t>(head.config.one_ray_per_end_voxel ? 1 : 0));
  writer.add(static_cast<std::uint8_t>(head.config.cost_fusion.rule));
  writer.add(std::bit_cast<std::uint32_t>(head.config.cost_fusion.information_limit));
  writer.add(head.scans);
  writer.add(head.cursor);
  write_pose(head.T_fleet_map, writer);
  for (int axis = 0; axis < 3; ++axis) writer.add(head.gravity_map[axis]);
  return writer.take();
}

std::optional<SelfLayerHead> decode_self_head(ByteView bytes) {
  ByteReader reader(bytes);
  SelfLayerHead head;
  head.number = reader.number<std::uint32_t>();
  head.frame_epoch = reader.number<std::uint64_t>();
  for (std::int64_t* const axis : {&head.origin.x, &head.origin.y, &head.origin.z}) {
    *axis = static_cast<std::int64_t>(reader.number<std::uint64_t>());
  }
  head.config.resolution_m = reader.real();
  SensorModel& model = head.config.sensor_model;
  for (double* const number : {&model.hit, &model.miss, &model.minimum, &model.maximum}) {
    *number = reader.real();
  }
  head.config.one_ray_per_end_voxel = reader.number<std::uint8_t>() != 0;
  const auto rule = reader.number<std::uint8_t>();
  head.config.cost_fusion.rule = static_cast<CostRule>(rule);
  const auto limit = std::bit_cast<float>(reader.number<std::uint32_t>());
  head.config.cost_fusion.information_limit = limit;
  head.scans = reader.number<std::uint64_t>();
  head.cursor = reader.number<std::uint32_t>();
  head.T_fleet_map = read_pose(reader);
  for (int axis = 0; axis < 3; ++axis) head.gravity_map[axis] = reader.real();
  const bool could_be_a_map = Resolution::from_metres(head.config.resolution_m) &&
                              model.is_valid() && rule <= 1 && limit >= 1.0F && limit <= 255.0F;
  if (!read_whole(reader) || !could_be_a_map || !head.T_fleet_map.checked() ||
      !head.gravity_map.allFinite()) {
    return std::nullopt;
  }
  return head;
}

Bytes encode_item_head(const LogItem& item) {
  ByteWriter writer;
  write_item_id(item.id, writer);
  writer.add(static_cast<std::uint8_t>((item.own ? 1 : 0) | (item.destination ? 2 : 0)));
  writer.add(item.kind);
  writer.add(item.destination ? item.destination->number : 0U);
  for (const MemberId from : item.receipts) writer.add(from.number);
  return writer.take();
}

std::optional<LogItem> decode_item_head(ByteView bytes) {
  ByteReader reader(bytes);
  LogItem item;
  item.id = read_item_id(reader);
  const auto flags = reader.number<std::uint8_t>();
  item.own = (flags & 1) != 0;
  item.kind = reader.number<std::uint16_t>();
  const MemberId destination{reader.number<std::uint32_t>()};
  if ((flags & 2) != 0) item.destination = destination;
  while (reader.complete() && reader.left() > 0) {
    item.receipts.push_back({reader.number<std::uint32_t>()});
  }
  if (!read_whole(reader) || flags > 3) return std::nullopt;
  if (!std::is_sorted(item.receipts.begin(), item.receipts.end())) return std::nullopt;
  return item;
}

Bytes encode_named(const NamedRow& row) {
  ByteWriter writer;
  writer.add(static_cast<std::uint8_t>(row.is_counter ? 1 : 0));
  writer.add(static_cast<std::uint16_t>(row.name.size()));
  for (const char letter : row.name) writer.add(static_cast<std::uint8_t>(letter));
  writer.add(ByteView(row.content));
  return writer.take();
}

std::optional<NamedRow> decode_named(ByteView bytes) {
  ByteReader reader(bytes);
  NamedRow row;
  const auto kind = reader.number<std::uint8_t>();
  row.is_counter = kind == 1;
  const ByteView name = reader.bytes(reader.number<std::uint16_t>());
  row.name.assign(name.begin(), name.end());
  const ByteView content = reader.bytes(reader.left());
  row.content.assign(content.begin(), content.end());
  if (!reader.complete() || kind > 1 || (row.is_counter && row.content.size() != 8)) {
    return std::nullopt;
  }
  return row;
}

Bytes encode_store_row(const StoreRow& row) {
  ByteWriter writer;
  writer.add(row.schema);
  writer.add(row.store);
  writer.add(row.commits);
  return writer.take();
}

std::optional<StoreRow> decode_store_row(ByteView bytes) {
  ByteReader reader(bytes);
  StoreRow row;
  row.schema = reader.number<std::uint32_t>();
  row.store = reader.number<std::uint64_t>();
  row.commits = reader.number<std::uint64_t>();
  return reader.complete() ? std::optional(row) : std::nullopt;
}

}  // namespace warren
