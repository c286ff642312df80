// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/session.hpp"

#include <utility>

#include <asio/buffer.hpp>
#include <asio/read.hpp>
#include <asio/write.hpp>

#include "daemon/control/response.hpp"
#include "proto/framing.hpp"

namespace warren {

ControlSession::ControlSession(Socket socket, const ControlHandler& handler,
                               std::function<void()> on_closed)
    : socket_(std::move(socket)),
      deadline_(socket_.get_executor()),
      handler_(handler),
      on_closed_(std::move(on_closed)) {}

void ControlSession::start() {
  watch_for_hangup();
  read_length_bytes();
}

// Nobody reads while a request is worked on, so that is not how a client's end is noticed then.
void ControlSession::watch_for_hangup() {
  socket_.async_wait(Socket::wait_error, [self = shared_from_this()](std::error_code error) {
    if (error) return;
    self->hung_up_ = true;
    self->hurry();
  });
}

void ControlSession::hurry() {
  if (const Hurry hurry = std::exchange(hurry_, nullptr)) hurry();
}

void ControlSession::read_length_bytes() {
  socket_.async_read_some(asio::buffer(length_),
                          [self = shared_from_this()](std::error_code error, std::size_t count) {
                            if (error) return self->close();
                            self->watch(kMessageTime);
                            self->read_rest_of_length(count);
                          });
}

void ControlSession::read_rest_of_length(std::size_t count) {
  asio::async_read(socket_, asio::buffer(asio::buffer(length_) + count),
                   [self = shared_from_this()](std::error_code error, std::size_t) {
                     if (error) return self->close();
                     self->read_body();
                   });
}

void ControlSession::read_body() {
  const std::uint32_t length = read_length(length_);
  working_ = true;
  if (length == 0 || length > kMaxControlFrameBytes) {
    return respond(encode_error("a request's length must be 1 to 1048576 bytes"), true);
  }
  body_.resize(length);
  asio::async_read(socket_, asio::buffer(body_),
                   [self = shared_from_this()](std::error_code error, std::size_t) {
                     if (error) return self->close();
                     self->handle();
                   });
}

void ControlSession::handle() {
  watching_ = false;
  deadline_.cancel();
  if (finishing_) return respond(encode_error("warrend is stopping"), true);
  const auto request = decode_control_request(body_);
  body_ = {};
  if (!request) return respond(encode_error(request.error()), false);
  hurry_ = handler_(*request, [self = shared_from_this()](std::string frame) {
    self->respond(std::move(frame), false);
  });
  if (hung_up_) hurry();
}

void ControlSession::respond(std::string frame, bool close_after) {
  hurry_ = nullptr;
  response_ = std::move(frame);
  watch(kMessageTime);
  asio::async_write(socket_, asio::buffer(response_),
                    [self = shared_from_this(), close_after](std::error_code error, std::size_t) {
                      self->watching_ = false;
                      self->deadline_.cancel();
                      self->working_ = false;
                      if (error || close_after || self->finishing_) return self->close();
                      self->read_length_bytes();
                    });
}

void ControlSession::watch(std::chrono::seconds time) {
  watching_ = true;
  deadline_.expires_after(time);
  deadline_.async_wait([self = shared_from_this()](std::error_code error) {
    // A wait that had expired already when its cause went away arrives without an error.
    const bool is_due =
        self->watching_ && self->deadline_.expiry() <= std::chrono::steady_clock::now();
    if (!error && is_due) self->close();
  });
}

void ControlSession::reject(const std::string& text) {
  working_ = true;
  respond(encode_error(text), true);
}

void ControlSession::finish() {
  finishing_ = true;
  hurry();
  if (!working_) close();
}

void ControlSession::close() {
  deadline_.cancel();
  hurry_ = nullptr;
  std::error_code ignored;
  socket_.close(ignored);
  if (const auto on_closed = std::exchange(on_closed_, nullptr)) on_closed();
}

}  // namespace warren
