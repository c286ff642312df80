// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/self_backlog.hpp"

#include <doctest/doctest.h>

namespace warren {
namespace {

BlockState block_at(std::uint16_t x, std::uint32_t changed_at) {
  BlockState block;
  block.key = {x, 0, 0};
  block.changed_at = changed_at;
  return block;
}

SelfLayerWrite write_of(std::uint32_t number, std::uint32_t cursor,
                        std::vector<BlockState> blocks) {
  SelfLayerWrite write;
  write.head.number = number;
  write.head.cursor = cursor;
  write.blocks = std::move(blocks);
  return write;
}

}  // namespace

TEST_CASE("of each block the latest state is stored, with the latest head of its layer") {
  SelfBacklog backlog;
  CHECK(backlog.empty());
  backlog.add(write_of(0, 1, {block_at(1, 1), block_at(2, 1)}));
  backlog.add(write_of(1, 1, {block_at(1, 1)}));
  backlog.add(write_of(0, 2, {block_at(2, 2), block_at(3, 2)}));
  const auto writes = backlog.take();
  REQUIRE(writes.size() == 2);
  CHECK(writes[0].head.cursor == 2);
  REQUIRE(writes[0].blocks.size() == 3);
  CHECK(writes[0].blocks[0].changed_at == 1);
  CHECK(writes[0].blocks[1].changed_at == 2);
  CHECK(writes[0].blocks[2].changed_at == 2);
  CHECK(writes[1].blocks.size() == 1);
  CHECK(backlog.empty());
  CHECK(backlog.take().empty());
}

TEST_CASE("a tick in which nothing changed is not stored, one in which only the head did is") {
  SelfBacklog backlog;
  backlog.add(write_of(0, 1, {block_at(1, 1)}));
  (void)backlog.take();
  backlog.add(write_of(0, 1, {}));
  CHECK(backlog.empty());
  SelfLayerWrite moved = write_of(0, 1, {});
  moved.head.T_fleet_map.translation.x() = 3.0;
  backlog.add(moved);
  REQUIRE_FALSE(backlog.empty());
  CHECK(backlog.take().at(0).blocks.empty());
}

TEST_CASE("what the store refused is taken again, but for blocks that changed since") {
  SelfBacklog backlog;
  backlog.add(write_of(0, 1, {block_at(1, 1), block_at(2, 1)}));
  CHECK(backlog.take().size() == 1);
  backlog.add(write_of(0, 2, {block_at(2, 2)}));
  backlog.on_refused();
  const auto writes = backlog.take();
  REQUIRE(writes.size() == 1);
  CHECK(writes[0].head.cursor == 2);
  REQUIRE(writes[0].blocks.size() == 2);
  CHECK(writes[0].blocks[0].changed_at == 1);
  CHECK(writes[0].blocks[1].changed_at == 2);
  backlog.on_stored();
  backlog.on_refused();
  CHECK(backlog.empty());
}

}  // namespace warren
