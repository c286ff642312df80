// SPDX-License-Identifier: Apache-2.0
// An OctoMap tree: no more blocks than allowed, in key order, none of them empty.
#include <cassert>

#include "core/exchange/octomap_reader.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  const auto tree = decode_octomap(fuzz::text_of(data, size));
  if (!tree) {
    assert(!tree.error().text.empty());
    return 0;
  }
  assert(tree->blocks.size() <= kOctomapBlocksMax);
  BlockOrdinal next = 0;
  for (const CodedBlock& coded : tree->blocks) {
    assert(coded.block >= next && coded.block < kOrdinalEnd && !coded.codes.empty());
    next = coded.block + 1;
  }
  return 0;
}
