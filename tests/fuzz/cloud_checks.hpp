// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "core/exchange/cloud_decoders.hpp"

namespace warren::fuzz {

using CloudDecoder = Decoded<Cloud> (*)(std::string_view);

// Whatever an error quotes from a file can be shown on a terminal.
inline void check_error(const DecodeError& error, std::string_view bytes) {
  assert(!error.text.empty());
  assert(std::all_of(error.text.begin(), error.text.end(),
                     [](char c) { return c >= ' ' && c <= '~'; }));
  const auto line_ends = std::count(bytes.begin(), bytes.end(), '\n');
  assert(error.line <= static_cast<std::size_t>(line_ends) + 1);
}

// Bits, so that NaN equals itself.
inline bool same_points(const std::vector<Point3f>& a, const std::vector<Point3f>& b) {
  const auto same_bits = [](const Point3f& p, const Point3f& q) {
    return std::memcmp(&p, &q, sizeof p) == 0;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_bits);
}

// For formats whose header tells the number of points: a file cut short is an error, not a smaller
// cloud.
inline void check_cut_short(CloudDecoder decode, std::string_view bytes, const Cloud& whole) {
  for (const std::size_t length : {bytes.size() / 2, bytes.size() - 1}) {
    const std::string cut(bytes.substr(0, length));  // a copy, or reads past its end go unseen
    const auto cloud = decode(cut);
    assert(!cloud || cloud->points.size() == whole.points.size());
  }
}

}  // namespace warren::fuzz
