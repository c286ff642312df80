// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <variant>

#include <tl/expected.hpp>

namespace warren {

inline constexpr std::size_t kMaxControlFrameBytes = 1048576;

struct StatusQuestion {};
struct MapInfoQuestion {};
struct ConfigQuestion {};
struct SaveOrder {
  std::filesystem::path path;  // absolute, without control characters
};
using ControlRequest = std::variant<StatusQuestion, MapInfoQuestion, ConfigQuestion, SaveOrder>;

// The error says what is wrong with the request.
tl::expected<ControlRequest, std::string> decode_control_request(std::span<const std::byte> bytes);

}  // namespace warren
