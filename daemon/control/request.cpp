// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/request.hpp"

#include <algorithm>

#include "warren/control.pb.h"

namespace warren {
namespace {

constexpr std::size_t kMaxPathBytes = 4095;  // PATH_MAX less the terminating zero

tl::expected<ControlRequest, std::string> save_order(const std::string& path) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
  if (path.empty() || path.front() != '/') {
    return tl::unexpected(std::string("map_save.path must be absolute"));
  }
  if (path.size() > kMaxPathBytes) return tl::unexpected(std::string("map_save.path is too long"));
  if (std::any_of(path.begin(), path.end(), is_control)) {
    return tl::unexpected(std::string("map_save.path has control characters"));
  }
  return SaveOrder{path};
}

}  // namespace

tl::expected<ControlRequest, std::string> decode_control_request(std::span<const std::byte> bytes) {
  control::Request request;
  if (bytes.size() > kMaxControlFrameBytes ||
      !request.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return tl::unexpected(std::string("this is no control Request"));
  }
  switch (request.body_case()) {
    case control::Request::kStatus:
      return StatusQuestion{};
    case control::Request::kMapInfo:
      return MapInfoQuestion{};
    case control::Request::kConfigPrint:
      return ConfigQuestion{};
    case control::Request::kMapSave:
      return save_order(request.map_save().path());
    default:
      return tl::unexpected(std::string("the request has no known body"));
  }
}

}  // namespace warren
