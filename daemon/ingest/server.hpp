// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>

#include <asio/io_context.hpp>
#include <asio/local/stream_protocol.hpp>

#include "daemon/config/config.hpp"
#include "daemon/ingest/server_status.hpp"
#include "daemon/ingest/session.hpp"
#include "daemon/log_throttle.hpp"
#include "daemon/mapper/mapper.hpp"

namespace warren {

// The ingest socket: takes scans from any number of clients to the mapper and brings receipts
// back. Everything here runs on the io_context's one thread; only receipts come from the mapper's.
class IngestServer : private IngestSessionOwner {
 public:
  // `listening` is a descriptor that listens already; the server closes it. None: nobody comes.
  IngestServer(asio::io_context& io, std::optional<int> listening, const Config& config,
               Mapper& mapper);

  void start() {
    if (acceptor_.is_open()) accept();
  }
  // Takes over what a reload may change: the sensors and the queue's length.
  void reconfigure(const Config& config);
  void deliver(ClientId client, const std::string& sensor, const ScanReceipt& receipt);
  IngestStatus status() const;

  // No new clients; `done` once all that has arrived is with the mapper.
  void drain(std::function<void()> done);
  // Sends what waits, closes every client.
  void finish();

 private:
  void accept();
  void on_accept(const std::error_code& error, IngestSession::Socket socket);
  void accept_later(const std::error_code& error);
  void add(IngestSession::Socket socket);
  void on_message(IngestSession& session, IngestMessage&& message) override;
  void on_refused(IngestSession& session, const Refused& refused) override;
  void on_reply_dropped() override { ++status_.replies_dropped; }
  void on_drained() override;
  void on_closed(IngestSession& session) override;

  void take(IngestSession& session, HelloMessage&& hello);
  void take(IngestSession& session, ScanMessage&& scan);
  void take(IngestSession& session, PoseUpdateMessage&& update);
  std::shared_ptr<IngestSession> find(ClientId client) const;
  void log_client(ClientId client, const std::string& what);

  asio::io_context& io_;
  asio::local::stream_protocol::acceptor acceptor_;
  asio::steady_timer accept_again_;
  IngestLimits limits_;
  IngestConfig config_;
  Mapper& mapper_;
  StampOrder stamps_;
  IngestStatus status_;
  LogThrottle throttle_;
  std::uint64_t last_client_ = 0;
  std::map<ClientId, std::shared_ptr<IngestSession>> sessions_;
  bool stopping_ = false;
  std::size_t draining_ = 0;
  std::function<void()> drained_;
};

}  // namespace warren
