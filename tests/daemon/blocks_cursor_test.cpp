// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/blocks_cursor.hpp"

#include <doctest/doctest.h>

#include "daemon/control/request.hpp"

namespace warren {

TEST_CASE("a cursor comes back from its bytes, and other bytes are none") {
  const BlocksCursor cursor{0x0123456789ABCDEF, 2, 3, 4, 5, kOrdinalEnd - 1};
  const std::string bytes = encode_cursor(cursor);
  CHECK(bytes.size() == 48);
  CHECK(decode_cursor(bytes) == cursor);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CHECK_FALSE(decode_cursor(std::string_view(bytes).substr(0, size)).has_value());
  }
  CHECK_FALSE(decode_cursor(bytes + "x").has_value());
  CHECK_FALSE(decode_cursor(encode_cursor({.since = 2, .until = 1})).has_value());
  CHECK_FALSE(decode_cursor(encode_cursor({.next = kOrdinalEnd + 1})).has_value());
  CHECK(decode_cursor(encode_cursor({}))->is_through());
}

TEST_CASE("each source and box has a scope of its own") {
  BlocksQuestion question;
  const std::uint64_t everywhere = question.scope();
  question.source = MapSource::kMerge;
  CHECK(question.scope() != everywhere);
  question.box = MapBox{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}};
  const std::uint64_t boxed = question.scope();
  question.box->high.z() = 1.1;
  CHECK(question.scope() != boxed);
  question.box->high.z() = 1.0;
  CHECK(question.scope() == boxed);
  std::swap(question.box->low.x(), question.box->low.y());
  CHECK(question.scope() == boxed);
}

}  // namespace warren
