// SPDX-License-Identifier: Apache-2.0
#include "daemon/ingest/replies.hpp"

#include "proto/framing.hpp"
#include "warren/ingest.pb.h"

namespace warren {
namespace {

ingest::ScanReceipt::Outcome outcome_of(ScanOutcome outcome) {
  switch (outcome) {
    case ScanOutcome::kTaken:
      return ingest::ScanReceipt::TAKEN;
    case ScanOutcome::kDroppedOverload:
      return ingest::ScanReceipt::DROPPED_OVERLOAD;
    case ScanOutcome::kDroppedOutOfOrder:
      return ingest::ScanReceipt::DROPPED_OUT_OF_ORDER;
    case ScanOutcome::kRejected:
      return ingest::ScanReceipt::REJECTED;
  }
  return ingest::ScanReceipt::OUTCOME_UNSPECIFIED;
}

}  // namespace

std::string encode_welcome(const IngestLimits& limits, std::uint32_t queue_scans) {
  ingest::IngestReply reply;
  auto* const welcome = reply.mutable_welcome();
  welcome->set_protocol_version(kIngestProtocolVersion);
  welcome->set_queue_scans(queue_scans);
  welcome->set_max_payload_bytes(limits.max_payload_bytes());
  for (const std::string& sensor : limits.sensors) welcome->add_sensors(sensor);
  return framed(reply.SerializeAsString());
}

std::string encode_receipt(const ScanReceipt& receipt) {
  ingest::IngestReply reply;
  auto* const message = reply.mutable_receipt();
  message->set_sequence(receipt.sequence);
  message->set_outcome(outcome_of(receipt.outcome));
  message->set_reason(receipt.reason);
  message->set_points_used(receipt.points_used);
  return framed(reply.SerializeAsString());
}

std::string encode_pose_updated(std::uint64_t frame_epoch, bool applied) {
  ingest::IngestReply reply;
  reply.mutable_pose_updated()->set_frame_epoch(frame_epoch);
  reply.mutable_pose_updated()->set_applied(applied);
  return framed(reply.SerializeAsString());
}

std::string encode_failure(const std::string& reason) {
  ingest::IngestReply reply;
  reply.mutable_failure()->set_reason(reason);
  return framed(reply.SerializeAsString());
}

}  // namespace warren
