// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/ask.hpp"

#include "tools/client/unix_stream.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

// Long enough to write a large map to a slow disk.
constexpr std::chrono::minutes kPatience{10};

}  // namespace

tl::expected<control::Response, std::string> ask_daemon(const std::string& socket,
                                                        const control::Request& request) {
  auto stream = UnixStream::connect(socket);
  if (!stream) return tl::unexpected(stream.error());
  if (const auto sent = stream->send_message(request.SerializeAsString()); !sent) {
    return tl::unexpected(sent.error());
  }
  const auto received = stream->receive_message(kPatience);
  if (!received) return tl::unexpected(received.error());
  if (!*received) return tl::unexpected(socket + ": warrend does not answer");
  control::Response response;
  if (!response.ParseFromString(**received)) {
    return tl::unexpected(socket + ": the answer is no control Response; is this warrend?");
  }
  if (response.has_error()) return tl::unexpected(response.error().text());
  return response;
}

}  // namespace warren
