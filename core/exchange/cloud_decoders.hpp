// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "core/exchange/cloud_reader.hpp"
#include "core/exchange/decode_error.hpp"

namespace warren {

// From the bytes of a whole file. Any bytes are safe: memory grows with what is there, not with
// what a header claims. May throw std::bad_alloc only.

// PCD 0.5-0.7: ascii, binary, binary_compressed; x y z as float32 or float64 among any fields.
Decoded<Cloud> decode_pcd(std::string_view bytes);
// PLY 1.0: ascii and binary little endian; x y z of the vertices as float or double.
Decoded<Cloud> decode_ply(std::string_view bytes);
// Records of four little-endian float32: x y z intensity.
Decoded<Cloud> decode_kitti_bin(std::string_view bytes);
// Lines of x y z and more columns, which are ignored; # comments. A first line of names says which
// columns are x, y and z if it has these.
Decoded<Cloud> decode_text_cloud(std::string_view bytes);

}  // namespace warren
