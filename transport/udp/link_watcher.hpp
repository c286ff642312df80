// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include <asio/io_context.hpp>
#include <asio/posix/stream_descriptor.hpp>

namespace warren::mesh {

// Says when any network interface or address of this machine has changed (rtnetlink).
class LinkWatcher : public std::enable_shared_from_this<LinkWatcher> {
 public:
  LinkWatcher(asio::io_context& io, std::function<void()> on_change);

  // False if the kernel does not tell us; then somebody must look now and then.
  bool start();
  void stop();

 private:
  void wait();
  void drain();

  asio::posix::stream_descriptor socket_;
  std::function<void()> on_change_;
};

}  // namespace warren::mesh
