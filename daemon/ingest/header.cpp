// SPDX-License-Identifier: Apache-2.0
#include "daemon/ingest/header.hpp"

#include <algorithm>
#include <set>

#include "warren/ingest.pb.h"

namespace warren {
namespace {

using Failure = tl::unexpected<Refused>;

Eigen::Vector3d vector_of(const ingest::Vector3& v) { return {v.x(), v.y(), v.z()}; }

Pose pose_of(const ingest::Pose& pose) {
  return {vector_of(pose.translation()),
          Eigen::Quaterniond(pose.qw(), pose.qx(), pose.qy(), pose.qz())};
}

std::string join(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all.append(all.empty() ? "" : ", ").append(name);
  return all;
}

tl::expected<IngestHeader, Refused> decode(const ingest::Hello& hello) {
  if (hello.protocol_version() != kIngestProtocolVersion) {
    return Failure({Refusal::kProtocolVersion,
                    "protocol_version must be " + std::to_string(kIngestProtocolVersion)});
  }
  if (hello.client().size() > kMaxClientTextBytes) {
    return Failure({Refusal::kLongText, "hello.client has more than 64 bytes"});
  }
  return IngestHeader{HelloMessage{hello.protocol_version(), hello.client()}, {}};
}

// Bytes per point; 0 for a type that is not known.
std::size_t bytes_of(ingest::Extra::Type type) {
  switch (type) {
    case ingest::Extra::UINT8:
      return 1;
    case ingest::Extra::UINT16:
      return 2;
    case ingest::Extra::FLOAT32:
      return 4;
    default:
      return 0;
  }
}

// Bytes per point of all extras together.
tl::expected<std::size_t, Refused> check_extras(const ingest::ScanHeader& scan) {
  if (scan.extras_size() > static_cast<int>(kMaxExtras)) {
    return Failure({Refusal::kBadExtras, "more than 8 extras"});
  }
  std::size_t bytes = 0;
  std::set<std::string> names;
  for (const ingest::Extra& extra : scan.extras()) {
    const std::size_t width = bytes_of(extra.type());
    if (width == 0) return Failure({Refusal::kBadExtras, "an extra of unknown type"});
    if (extra.name().empty() || extra.name().size() > kMaxExtraNameBytes) {
      return Failure({Refusal::kBadExtras, "an extra's name needs 1 to 32 bytes"});
    }
    if (!names.insert(extra.name()).second) {
      return Failure({Refusal::kBadExtras, "two extras of one name"});
    }
    if (extra.name() == "stair" && extra.type() != ingest::Extra::UINT8) {
      return Failure({Refusal::kBadExtras, "the extra stair must be UINT8"});
    }
    bytes += width;
  }
  return bytes;
}

tl::expected<void, Refused> check_scan(const ingest::ScanHeader& scan, const IngestLimits& limits) {
  const auto& known = limits.sensors;
  if (std::find(known.begin(), known.end(), scan.sensor()) == known.end()) {
    // Cutting a name could split a character.
    const bool shown = scan.sensor().size() <= kMaxClientTextBytes;
    return Failure({Refusal::kUnknownSensor, "no sensor '" + (shown ? scan.sensor() : "...") +
                                                 "' in the config; there are: " + join(known)});
  }
  if (std::uint64_t{scan.points()} + scan.no_returns() > limits.max_points) {
    return Failure({Refusal::kTooManyPoints, "points and no_returns exceed ingest.max_points = " +
                                                 std::to_string(limits.max_points)});
  }
  return {};
}

tl::expected<IngestHeader, Refused> decode(const ingest::ScanHeader& scan,
                                           const IngestLimits& limits) {
  if (const auto checked = check_scan(scan, limits); !checked) return Failure(checked.error());
  const auto extra_bytes = check_extras(scan);
  if (!extra_bytes) return Failure(extra_bytes.error());

  ScanMessage message;
  message.sequence = scan.sequence();
  message.sensor = scan.sensor();
  message.frame_epoch = scan.frame_epoch();
  message.stamp_ns = scan.stamp_ns();
  message.scan.T_map_base = pose_of(scan.t_map_base());
  if (scan.has_t_base_sensor()) message.scan.T_base_sensor = pose_of(scan.t_base_sensor());
  if (scan.has_gravity_map()) message.scan.gravity_map = vector_of(scan.gravity_map());
  return IngestHeader{std::move(message),
                      {scan.points(), scan.no_returns(), scan.points() * *extra_bytes}};
}

}  // namespace

tl::expected<IngestHeader, Refused> decode_ingest_header(std::span<const std::byte> bytes,
                                                         const IngestLimits& limits) {
  ingest::IngestRequest request;
  if (bytes.size() > kMaxIngestHeaderBytes ||
      !request.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return Failure({Refusal::kNotProtobuf, "the header is no IngestRequest"});
  }
  switch (request.body_case()) {
    case ingest::IngestRequest::kHello:
      return decode(request.hello());
    case ingest::IngestRequest::kScan:
      return decode(request.scan(), limits);
    case ingest::IngestRequest::kPoseUpdate: {
      const auto& update = request.pose_update();
      return IngestHeader{PoseUpdateMessage{update.frame_epoch(), pose_of(update.t_fleet_map())},
                          {}};
    }
    default:
      return Failure({Refusal::kNoBody, "the request has no known body"});
  }
}

void silence_protobuf() { google::protobuf::SetLogHandler(nullptr); }

const char* name_of(Refusal refusal) {
  switch (refusal) {
    case Refusal::kHeaderLength:
      return "header_length";
    case Refusal::kNotProtobuf:
      return "not_protobuf";
    case Refusal::kNoBody:
      return "no_body";
    case Refusal::kNoHello:
      return "no_hello";
    case Refusal::kSecondHello:
      return "second_hello";
    case Refusal::kProtocolVersion:
      return "protocol_version";
    case Refusal::kLongText:
      return "long_text";
    case Refusal::kUnknownSensor:
      return "unknown_sensor";
    case Refusal::kTooManyPoints:
      return "too_many_points";
    case Refusal::kBadExtras:
      return "bad_extras";
    case Refusal::kTruncated:
      return "truncated";
    case Refusal::kStalled:
      return "stalled";
    case Refusal::kTooManyClients:
      return "too_many_clients";
  }
  return "unknown";
}

}  // namespace warren
