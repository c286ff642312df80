// SPDX-License-Identifier: Apache-2.0
#include "tools/client/ingest_client.hpp"

#include <bit>
#include <span>
#include <utility>

#include "warren/ingest.pb.h"

namespace warren {
namespace {

constexpr std::uint32_t kProtocolVersion = 1;
static_assert(std::endian::native == std::endian::little, "points go out as they lie in memory");
static_assert(sizeof(Point3f) == 12);

void set_vector(const Eigen::Vector3d& from, ingest::Vector3& to) {
  to.set_x(from.x());
  to.set_y(from.y());
  to.set_z(from.z());
}

void set_pose(const Pose& from, ingest::Pose& to) {
  set_vector(from.translation, *to.mutable_translation());
  to.set_qx(from.rotation.x());
  to.set_qy(from.rotation.y());
  to.set_qz(from.rotation.z());
  to.set_qw(from.rotation.w());
}

std::string header_of(const OutgoingScan& outgoing) {
  ingest::IngestRequest request;
  ingest::ScanHeader& header = *request.mutable_scan();
  header.set_sequence(outgoing.sequence);
  header.set_sensor(outgoing.sensor);
  header.set_frame_epoch(outgoing.frame_epoch);
  header.set_stamp_ns(outgoing.stamp_ns);
  set_pose(outgoing.scan.T_map_base, *header.mutable_t_map_base());
  set_pose(outgoing.scan.T_base_sensor, *header.mutable_t_base_sensor());
  set_vector(outgoing.scan.gravity_map, *header.mutable_gravity_map());
  header.set_points(static_cast<std::uint32_t>(outgoing.scan.points_sensor.size()));
  header.set_no_returns(
      static_cast<std::uint32_t>(outgoing.scan.no_return_directions_sensor.size()));
  return request.SerializeAsString();
}

Receipt receipt_of(const ingest::ScanReceipt& message) {
  Receipt receipt{message.sequence(), ScanOutcome::kRejected, message.reason()};
  if (message.outcome() == ingest::ScanReceipt::TAKEN) receipt.outcome = ScanOutcome::kTaken;
  if (message.outcome() == ingest::ScanReceipt::DROPPED_OVERLOAD) {
    receipt.outcome = ScanOutcome::kDroppedOverload;
  }
  if (message.outcome() == ingest::ScanReceipt::DROPPED_OUT_OF_ORDER) {
    receipt.outcome = ScanOutcome::kDroppedOutOfOrder;
  }
  return receipt;
}

tl::expected<ingest::IngestReply, std::string> parse_reply(const std::string& bytes) {
  ingest::IngestReply reply;
  if (!reply.ParseFromString(bytes))
    return tl::unexpected(std::string("the daemon sent what is no reply"));
  if (reply.has_failure()) {
    return tl::unexpected("the daemon refused: " + reply.failure().reason());
  }
  return reply;
}

}  // namespace

tl::expected<IngestClient, std::string> IngestClient::connect(const std::string& socket,
                                                              const std::string& client_name,
                                                              std::chrono::milliseconds patience) {
  auto stream = UnixStream::connect(socket);
  if (!stream) return tl::unexpected(stream.error());
  IngestClient client(std::move(*stream));
  if (const auto greeted = client.greet(client_name, patience); !greeted) {
    return tl::unexpected(greeted.error());
  }
  return client;
}

tl::expected<void, std::string> IngestClient::greet(const std::string& client_name,
                                                    std::chrono::milliseconds patience) {
  ingest::IngestRequest request;
  request.mutable_hello()->set_protocol_version(kProtocolVersion);
  request.mutable_hello()->set_client(client_name);
  if (auto sent = stream_.send_message(request.SerializeAsString()); !sent) return sent;
  const auto bytes = stream_.receive_message(patience);
  if (!bytes) return tl::unexpected(bytes.error());
  if (!*bytes) return tl::unexpected(std::string("the daemon does not answer"));
  const auto reply = parse_reply(**bytes);
  if (!reply) return tl::unexpected(reply.error());
  if (!reply->has_welcome()) return tl::unexpected(std::string("the daemon did not welcome us"));
  const ingest::Welcome& welcome = reply->welcome();
  welcome_ = {welcome.queue_scans(),
              welcome.max_payload_bytes(),
              {welcome.sensors().begin(), welcome.sensors().end()}};
  return {};
}

tl::expected<void, std::string> IngestClient::send(const OutgoingScan& outgoing) {
  if (auto sent = stream_.send_message(header_of(outgoing)); !sent) return sent;
  const auto bytes_of = [](const std::vector<Point3f>& points) {
    return std::as_bytes(std::span(points));
  };
  if (auto sent = stream_.send_bytes(bytes_of(outgoing.scan.points_sensor)); !sent) {
    return sent;
  }
  return stream_.send_bytes(bytes_of(outgoing.scan.no_return_directions_sensor));
}

tl::expected<std::optional<Receipt>, std::string> IngestClient::receive(
    std::chrono::milliseconds timeout) {
  const auto bytes = stream_.receive_message(timeout);
  if (!bytes) return tl::unexpected(bytes.error());
  if (!*bytes) return std::nullopt;
  const auto reply = parse_reply(**bytes);
  if (!reply) return tl::unexpected(reply.error());
  if (!reply->has_receipt()) return std::nullopt;
  return receipt_of(reply->receipt());
}

}  // namespace warren
