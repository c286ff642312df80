// SPDX-License-Identifier: Apache-2.0
#include "daemon/ingest/server.hpp"

#include <asio/post.hpp>

#include "daemon/log.hpp"
#include "daemon/socket_file.hpp"

namespace warren {
namespace {

IngestLimits limits_of(const Config& config) {
  IngestLimits limits{config.ingest.max_points, {}};
  for (const SensorConfig& sensor : config.sensors) limits.sensors.push_back(sensor.name);
  return limits;
}

}  // namespace

IngestServer::IngestServer(asio::io_context& io, std::optional<int> listening, const Config& config,
                           Mapper& mapper)
    : io_(io),
      acceptor_(io),
      accept_again_(io),
      limits_(limits_of(config)),
      config_(config.ingest),
      mapper_(mapper) {
  if (listening) acceptor_.assign(asio::local::stream_protocol(), *listening);
  for (const std::string& sensor : limits_.sensors) status_.sensors[sensor];
}

void IngestServer::reconfigure(const Config& config) {
  limits_.sensors = limits_of(config).sensors;
  config_.queue_scans = config.ingest.queue_scans;
  for (const std::string& sensor : limits_.sensors) status_.sensors[sensor];
}

void IngestServer::accept() {
  acceptor_.async_accept([this](std::error_code error, IngestSession::Socket socket) {
    on_accept(error, std::move(socket));
  });
}

void IngestServer::on_accept(const std::error_code& error, IngestSession::Socket socket) {
  if (stopping_) return;
  if (error) return accept_later(error);
  add(std::move(socket));
  accept();
}

void IngestServer::accept_later(const std::error_code& error) {
  if (throttle_.allows(std::chrono::steady_clock::now())) {
    log_warning("ingest: cannot accept a client: " + error.message());
  }
  accept_again_.expires_after(kAcceptPause);
  accept_again_.async_wait([this](std::error_code cancelled) {
    if (!cancelled && !stopping_) accept();
  });
}

void IngestServer::add(IngestSession::Socket socket) {
  const ClientId id{++last_client_};
  const bool is_one_too_many = sessions_.size() >= config_.max_clients;
  IngestSessionOwner& owner = *this;
  const std::chrono::duration<double> timeout(config_.message_timeout_s);
  const auto session =
      std::make_shared<IngestSession>(std::move(socket), id, limits_, timeout, owner);
  sessions_[id] = session;
  if (!is_one_too_many) return session->start();
  session->refuse({Refusal::kTooManyClients, "as many clients as ingest.max_clients allows: " +
                                                 std::to_string(config_.max_clients)});
}

void IngestServer::on_message(IngestSession& session, IngestMessage&& message) {
  std::visit([&](auto&& body) { take(session, std::forward<decltype(body)>(body)); },
             std::move(message));
}

void IngestServer::take(IngestSession& session, HelloMessage&& hello) {
  log_client(session.id(), "connected: " + hello.client);
  session.send(encode_welcome(limits_, config_.queue_scans));
}

void IngestServer::take(IngestSession& session, ScanMessage&& scan) {
  const std::string sensor = scan.sensor;
  const std::uint64_t sequence = scan.sequence;
  SensorCounts& counts = status_.sensors[sensor];
  ++counts.received;
  if (!stamps_.advance(sensor, scan.frame_epoch, scan.stamp_ns)) {
    const char* const reason = "stamp_ns is not after the last one of this sensor and frame_epoch";
    return deliver(session.id(), sensor, {sequence, ScanOutcome::kDroppedOutOfOrder, reason, 0});
  }
  for (const QueuedScan& dropped : mapper_.push({session.id(), std::move(scan)})) {
    deliver(dropped.client, dropped.message.sensor,
            {dropped.message.sequence, ScanOutcome::kDroppedOverload, "a newer scan came", 0});
  }
}

void IngestServer::take(IngestSession& session, PoseUpdateMessage&& update) {
  session.pause();  // one at a time: what it asks of the mapper stays bounded
  const auto answer = [this, client = session.id(), epoch = update.frame_epoch](bool applied) {
    asio::post(io_, [this, client, epoch, applied] {
      const auto waiting = find(client);
      if (!waiting) return;
      waiting->send(encode_pose_updated(epoch, applied));
      waiting->resume();
    });
  };
  if (!mapper_.update_pose(update, answer)) answer(false);
}

void IngestServer::deliver(ClientId client, const std::string& sensor, const ScanReceipt& receipt) {
  SensorCounts& counts = status_.sensors[sensor];
  switch (receipt.outcome) {
    case ScanOutcome::kTaken:
      ++counts.taken;
      break;
    case ScanOutcome::kDroppedOverload:
      ++counts.dropped_overload;
      break;
    case ScanOutcome::kDroppedOutOfOrder:
      ++counts.dropped_out_of_order;
      break;
    case ScanOutcome::kRejected:
      ++counts.rejected;
      break;
  }
  if (const auto session = find(client)) session->send(encode_receipt(receipt));
}

void IngestServer::on_refused(IngestSession& session, const Refused& refused) {
  ++status_.refused[static_cast<std::size_t>(refused.refusal)];
  log_client(session.id(), "refused: " + refused.text);
}

void IngestServer::on_closed(IngestSession& session) {
  sessions_.erase(session.id());  // its running handler keeps it alive
}

IngestStatus IngestServer::status() const {
  IngestStatus status = status_;
  status.clients = static_cast<std::uint32_t>(sessions_.size());
  return status;
}

void IngestServer::drain(std::function<void()> done) {
  stopping_ = true;
  std::error_code ignored;
  acceptor_.close(ignored);
  accept_again_.cancel();
  drained_ = std::move(done);
  draining_ = sessions_.size() + 1;
  const auto sessions = sessions_;  // draining may close some
  for (const auto& [id, session] : sessions) session->drain();
  on_drained();
}

void IngestServer::on_drained() {
  if (--draining_ == 0) drained_();
}

void IngestServer::finish() {
  const auto sessions = sessions_;
  for (const auto& [id, session] : sessions) session->finish();
}

std::shared_ptr<IngestSession> IngestServer::find(ClientId client) const {
  const auto found = sessions_.find(client);
  return found == sessions_.end() ? nullptr : found->second;
}

void IngestServer::log_client(ClientId client, const std::string& what) {
  if (!throttle_.allows(std::chrono::steady_clock::now())) return;
  log_info("ingest: client " + std::to_string(static_cast<std::uint64_t>(client)) + " " + what);
}

}  // namespace warren
