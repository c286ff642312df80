// SPDX-License-Identifier: Apache-2.0
#include "daemon/ingest/session.hpp"

#include <asio/buffer.hpp>
#include <asio/write.hpp>

#include "daemon/ingest/replies.hpp"

namespace warren {
namespace {

auto as_buffer(std::span<std::byte> bytes) { return asio::buffer(bytes.data(), bytes.size()); }

}  // namespace

IngestSession::IngestSession(Socket socket, ClientId id, const IngestLimits& limits,
                             std::chrono::duration<double> message_timeout,
                             IngestSessionOwner& owner)
    : socket_(std::move(socket)),
      deadline_(socket_.get_executor()),
      id_(id),
      limits_(limits),
      message_timeout_(message_timeout),
      owner_(owner) {}

void IngestSession::start() {
  set_deadline(message_timeout_);  // for the hello
  read();
}

void IngestSession::read() {
  if (reading_ || paused_ || state_ != State::kOpen) return;
  reading_ = true;
  socket_.async_read_some(as_buffer(decoder_.buffer()),
                          [self = shared_from_this()](std::error_code error, std::size_t count) {
                            self->reading_ = false;
                            self->on_read(error, count);
                          });
}

void IngestSession::on_read(const std::error_code& error, std::size_t count) {
  if (state_ == State::kAnswering || state_ == State::kFinishing || state_ == State::kClosed)
    return;
  if (!error) take(count);
  if (state_ == State::kDraining && !paused_) return drain_now();
  if (error) return on_end_of_stream();
  read();
}

void IngestSession::take(std::size_t count) {
  auto message = decoder_.commit(count, limits_);
  if (!message) return refuse(message.error());
  if (*message) {
    deadline_set_ = false;
    deadline_.cancel();
    ++owed_replies_;
    owner_.on_message(*this, std::move(**message));
  } else {
    watch_message();
  }
}

// A message that has begun must end in time; so must the silence before the hello.
void IngestSession::watch_message() {
  if (!deadline_set_ && decoder_.is_within_message()) set_deadline(message_timeout_);
}

void IngestSession::set_deadline(std::chrono::duration<double> time) {
  deadline_set_ = true;
  deadline_.expires_after(std::chrono::duration_cast<std::chrono::nanoseconds>(time));
  deadline_.async_wait([self = shared_from_this()](std::error_code error) {
    // A wait that had expired already when its message became whole arrives without an error.
    const bool is_due =
        self->deadline_set_ && self->deadline_.expiry() <= std::chrono::steady_clock::now();
    if (!error && is_due) self->on_deadline();
  });
}

void IngestSession::on_deadline() {
  deadline_set_ = false;
  if (state_ == State::kFinishing) return close();
  if (state_ == State::kOpen) {
    refuse({Refusal::kStalled, "no whole message within ingest.message_timeout_s"});
  }
}

void IngestSession::on_end_of_stream() {
  if (decoder_.is_within_message()) {
    owner_.on_refused(*this, {Refusal::kTruncated, "the connection ended within a message"});
  }
  // It may have closed its side for writing only, and wait for receipts.
  state_ = State::kAnswering;
  close_if_answered();
}

void IngestSession::close_if_answered() {
  const bool all_sent = owed_replies_ == 0 && !writing_ && unsent_.empty();
  if (state_ == State::kAnswering && (all_sent || deaf_)) close();
}

void IngestSession::refuse(const Refused& refused) {
  if (state_ == State::kFinishing || state_ == State::kClosed) return;
  const bool was_draining = state_ == State::kDraining;
  owner_.on_refused(*this, refused);
  unsent_.append(encode_failure(refused.text));
  finish();
  if (was_draining) owner_.on_drained();
}

void IngestSession::resume() {
  paused_ = false;
  if (state_ == State::kDraining) return drain_now();
  read();
}

void IngestSession::drain() {
  if (state_ != State::kOpen) return owner_.on_drained();
  state_ = State::kDraining;
  std::error_code ignored;
  if (reading_) {
    socket_.cancel(ignored);  // its handler goes on
  } else if (!paused_) {
    drain_now();
  }
}

void IngestSession::drain_now() {
  std::error_code error;
  socket_.non_blocking(true, error);
  while (!error && drained_bytes_ < kMaxDrainBytes) {
    const std::size_t count = socket_.read_some(as_buffer(decoder_.buffer()), error);
    if (error) break;
    drained_bytes_ += count;
    take(count);
    if (state_ != State::kDraining || paused_) return;  // refused, or resume() goes on
  }
  state_ = State::kDrained;
  owner_.on_drained();
}

void IngestSession::send(const std::string& frame) {
  if (state_ == State::kFinishing || state_ == State::kClosed) return;
  --owed_replies_;
  if (deaf_ || unsent_.size() + frame.size() > kMaxUnsentBytes) {
    owner_.on_reply_dropped();
  } else {
    unsent_.append(frame);
    write();
  }
  close_if_answered();
}

void IngestSession::write() {
  if (writing_ || unsent_.empty() || state_ == State::kClosed) return;
  writing_ = true;
  sending_.swap(unsent_);
  unsent_.clear();
  asio::async_write(
      socket_, asio::buffer(sending_),
      [self = shared_from_this()](std::error_code error, std::size_t) { self->on_written(error); });
}

// A client that has closed may have left scans in the socket's buffer: they are read to the end.
void IngestSession::on_written(const std::error_code& error) {
  writing_ = false;
  sending_.clear();
  if (error) {
    deaf_ = true;
    unsent_.clear();
  }
  if (state_ == State::kFinishing && unsent_.empty()) return close();
  write();
  close_if_answered();
}

void IngestSession::finish() {
  if (state_ == State::kFinishing || state_ == State::kClosed) return;
  state_ = State::kFinishing;
  if (!writing_ && unsent_.empty()) return close();
  set_deadline(kFlushTime);
  write();
}

void IngestSession::close() {
  if (state_ == State::kClosed) return;
  const bool was_draining = state_ == State::kDraining;
  state_ = State::kClosed;
  deadline_.cancel();
  std::error_code ignored;
  socket_.close(ignored);
  owner_.on_closed(*this);
  if (was_draining) owner_.on_drained();
}

}  // namespace warren
