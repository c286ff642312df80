// SPDX-License-Identifier: Apache-2.0
// A layer file, with the checksum that a forger would give it: what is read has the digest it says,
// and comes back from a file of its own.
#include <cassert>
#include <vector>

#include "core/exchange/layer_file.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace warren::fuzz {
namespace {

void check(std::span<const std::uint8_t> bytes) {
  const auto layer = decode_layer(bytes);
  if (!layer) return;
  const auto again = decode_layer(encode_layer(*layer));
  assert(again && again->digest().root() == layer->digest().root());
  assert(again->holdings() == layer->holdings() && again->pose() == layer->pose());
}

}  // namespace
}  // namespace warren::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  fuzz::check({data, size});
  std::vector<std::uint8_t> bytes(data, data + size);
  const Hash checksum = hash_of_bytes(bytes);
  bytes.insert(bytes.end(), checksum.begin(), checksum.end());
  fuzz::check(bytes);
  return 0;
}
