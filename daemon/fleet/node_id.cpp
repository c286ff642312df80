// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/node_id.hpp"

#include <array>

#include <sodium.h>

namespace warren {

std::uint32_t node_id(const std::string& name) {
  std::array<std::uint8_t, crypto_generichash_BYTES> hash{};
  crypto_generichash(hash.data(), hash.size(), reinterpret_cast<const std::uint8_t*>(name.data()),
                     name.size(), nullptr, 0);
  std::uint32_t id = 0;
  for (std::size_t i = 0; i < sizeof id; ++i) id |= std::uint32_t{hash[i]} << 8 * i;
  return id;
}

}  // namespace warren
