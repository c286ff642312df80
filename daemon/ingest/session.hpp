// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include <asio/local/stream_protocol.hpp>
#include <asio/steady_timer.hpp>

#include "daemon/ingest/decoder.hpp"
#include "daemon/mapper/scan_queue.hpp"

namespace warren {

class IngestSession;

// What a session tells its server. A refusal is told once; so is the end, which may come within
// any call of the session.
class IngestSessionOwner {
 public:
  virtual ~IngestSessionOwner() = default;
  virtual void on_message(IngestSession& session, IngestMessage&& message) = 0;
  virtual void on_refused(IngestSession& session, const Refused& refused) = 0;
  virtual void on_reply_dropped() = 0;
  virtual void on_drained() = 0;
  virtual void on_closed(IngestSession& session) = 0;
};

// One client of the ingest socket: bytes in, messages to the owner, replies out. It waits for
// nobody else, and nobody waits for it. Lives until both its socket and its handlers are done.
class IngestSession : public std::enable_shared_from_this<IngestSession> {
 public:
  using Socket = asio::local::stream_protocol::socket;
  // Replies to a client that does not read them wait up to here; then new ones are dropped.
  static constexpr std::size_t kMaxUnsentBytes = std::size_t{64} * 1024;
  // What the socket's buffer can hold when the daemon stops is less than this.
  static constexpr std::size_t kMaxDrainBytes = std::size_t{4} * 1024 * 1024;
  static constexpr std::chrono::seconds kFlushTime{1};

  IngestSession(Socket socket, ClientId id, const IngestLimits& limits,
                std::chrono::duration<double> message_timeout, IngestSessionOwner& owner);

  void start();
  ClientId id() const { return id_; }
  void send(const std::string& frame);
  // Says why, and closes.
  void refuse(const Refused& refused);
  // Stops and resumes reading; what arrives meanwhile waits in the socket.
  void pause() { paused_ = true; }
  void resume();
  // Takes what the kernel has of this client, then on_drained().
  void drain();
  // Sends what waits, then closes.
  void finish();

 private:
  // Answering: the client sends no more, but replies are still owed to it.
  enum class State { kOpen, kAnswering, kDraining, kDrained, kFinishing, kClosed };

  void read();
  void on_read(const std::error_code& error, std::size_t count);
  void take(std::size_t count);
  void drain_now();
  void write();
  void on_written(const std::error_code& error);
  void close_if_answered();
  void on_end_of_stream();
  void watch_message();
  void set_deadline(std::chrono::duration<double> time);
  void on_deadline();
  void close();

  Socket socket_;
  asio::steady_timer deadline_;
  ClientId id_;
  const IngestLimits& limits_;
  std::chrono::duration<double> message_timeout_;
  IngestSessionOwner& owner_;
  IngestDecoder decoder_;
  State state_ = State::kOpen;
  bool reading_ = false;
  bool paused_ = false;
  bool deadline_set_ = false;
  std::size_t drained_bytes_ = 0;
  bool writing_ = false;
  bool deaf_ = false;              // a write has failed: nobody reads replies any more
  std::int64_t owed_replies_ = 0;  // every message is answered by one
  std::string unsent_;
  std::string sending_;
};

}  // namespace warren
