// SPDX-License-Identifier: Apache-2.0
#include "transport/wire/key_schedule.hpp"

#include <cassert>
#include <initializer_list>
#include <string_view>
#include <vector>

#include <sodium/core.h>
#include <sodium/crypto_generichash_blake2b.h>

#include "transport/wire/packet_writer.hpp"

namespace warren::mesh {
namespace {

// BLAKE2b-256, keyed with the fleet's secret, of the label and the boots. No label is a prefix of
// another, so no two purposes share an input.
Key derive(const Key& fleet_key, std::string_view label, std::initializer_list<BootId> boots) {
  std::vector<std::uint8_t> input(label.begin(), label.end());
  PacketWriter writer(input);
  for (const BootId boot : boots) writer.fixed(boot.bits, 8);
  Key key;
  crypto_generichash_blake2b(key.data(), key.size(), input.data(), input.size(), fleet_key.data(),
                             fleet_key.size());
  return key;
}

}  // namespace

PresharedKeys::PresharedKeys(const Key& fleet_key) : fleet_key_(fleet_key) {
  [[maybe_unused]] const int ready = sodium_init();
  assert(ready >= 0);
}

Key PresharedKeys::group_key(BootId sender) const {
  return derive(fleet_key_, "warren mesh 1 group", {sender});
}

Key PresharedKeys::pair_key(BootId sender, BootId receiver) const {
  return derive(fleet_key_, "warren mesh 1 pair", {sender, receiver});
}

}  // namespace warren::mesh
