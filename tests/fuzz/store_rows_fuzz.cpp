// SPDX-License-Identifier: Apache-2.0
// A row of the store: the first byte says which kind. Whatever is taken has this one encoding.
#include <algorithm>
#include <cassert>

#include "daemon/store/block_bytes.hpp"
#include "daemon/store/head_bytes.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace warren::fuzz {
namespace {

void check(const Bytes& encoded, ByteView bytes) {
  assert(std::equal(encoded.begin(), encoded.end(), bytes.begin(), bytes.end()));
}

// Layers and self-layers are not compared: they hold numbers of which some are put right.
void decode(std::uint8_t kind, ByteView bytes) {
  if (kind == 0) {
    if (const auto block = decode_block(5, bytes)) check(encode_block(*block), bytes);
  } else if (kind == 1) {
    const auto state = decode_self_block(5, bytes);
    if (state) check(encode_self_block(*state), bytes);
  } else if (kind == 2) {
    if (const auto row = decode_layer_row(bytes)) assert(decode_layer_row(encode_layer_row(*row)));
  } else if (kind == 3) {
    if (const auto head = decode_self_head(bytes))
      assert(decode_self_head(encode_self_head(*head)));
  } else if (kind == 4) {
    if (const auto item = decode_item_head(bytes))
      assert(decode_item_head(encode_item_head(*item)));
  } else if (kind == 5) {
    if (const auto named = decode_named(bytes)) check(encode_named(*named), bytes);
  } else {
    decode_store_row(bytes);
  }
}

}  // namespace
}  // namespace warren::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) warren::fuzz::decode(data[0] % 7, {data + 1, size - 1});
  return 0;
}
