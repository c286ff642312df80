// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/layer_book.hpp"

#include "tests/core/layer/replica_steps.hpp"

namespace warren::replication {
namespace {

using test::block_with;
using test::encoded;
using test::kLayer;

struct Books {
  Replica origin{kLayer, kDefaultResolution};
  LayerBook book{{4, 8, 1 << 20}};
  HeldLayer& copy() {
    CHECK(book.admit(kLayer, kDefaultResolution) == Admission::kAdmitted);
    return *book.find(kLayer);
  }
  void publish(std::uint32_t place, BlockOrdinal block = 100) {
    test::publish(origin, {block_with(block, place, VoxelCode::free())});
  }
};

TEST_CASE("layers are admitted up to the bound") {
  LayerBook book({2, 8, 1 << 20});
  CHECK(book.admit({1, 0, 5}, kDefaultResolution) == Admission::kAdmitted);
  CHECK(book.admit({1, 0, 5}, kDefaultResolution) == Admission::kKnown);
  CHECK(book.admit({1, 0, 5}, *Resolution::from_metres(0.2)) == Admission::kOtherResolution);
  CHECK(book.admit({1, 1, 5}, kDefaultResolution) == Admission::kAdmitted);
  CHECK(book.admit({1, 2, 5}, kDefaultResolution) == Admission::kFull);
  CHECK(book.layers_refused() == 1);
}

TEST_CASE("nobody writes a layer of ours") {
  Books books;
  books.publish(1);
  REQUIRE(books.book.add_own(books.origin));
  CHECK(books.book.admit(kLayer, kDefaultResolution) == Admission::kOwnLayer);
  const auto applied =
      books.book.apply({}, *books.book.find(kLayer), encoded(books.origin, 0).bytes);
  CHECK(applied.refused == Refusal::kOwnLayer);
}

TEST_CASE("a copy takes no more regions than it may") {
  Books books;
  HeldLayer& copy = books.copy();
  for (std::uint64_t region = 0; region < 10; ++region) {
    test::publish(books.origin, {block_with(region << 9, 0, VoxelCode::free())});
    const auto applied =
        books.book.apply({}, copy, encoded(books.origin, static_cast<std::uint32_t>(region)).bytes);
    CHECK(applied.refused.has_value() == (region >= 8));
  }
  CHECK(copy.full);
  CHECK(copy.copy->regions() == 8);
}

TEST_CASE("copies take no more memory than they may, and go on when they have been laid to rest") {
  Replica origin{kLayer, kDefaultResolution};
  LayerBook book({4, 8192, 500'000});
  CHECK(book.admit(kLayer, kDefaultResolution) == Admission::kAdmitted);
  HeldLayer& copy = *book.find(kLayer);
  std::uint64_t region = 0;
  while (!copy.full && region < 8192) {
    std::vector<CodedBlock> blocks;
    for (BlockOrdinal i = 0; i < 4; ++i) {
      blocks.push_back(block_with(region * 512 + i, 1, VoxelCode::free()));
    }
    test::publish(origin, blocks);
    const auto revision = static_cast<std::uint32_t>(region);
    book.apply({}, copy, encoded(origin, revision).bytes);
    ++region;
  }
  REQUIRE(copy.full);
  CHECK(book.memory_bytes() >= 500'000);
  CHECK(book.memory_bytes() < 1'000'000);
  CHECK(book.refused(Refusal::kNoRoom) == 1);
  book.review_room(MeshTime{});
  CHECK(copy.full);
  CHECK(copy.copy->rest(copy.highest(), region) > 0);
  copy.not_batched.clear();
  book.review_room(MeshTime{} + std::chrono::seconds(5));
  CHECK(copy.full);
  book.review_room(MeshTime{} + std::chrono::seconds(11));
  CHECK_FALSE(copy.full);
  const auto missed = static_cast<std::uint32_t>(region - 1);
  CHECK(book.apply({}, copy, encoded(origin, missed).bytes).result == ApplyResult::kApplied);
}

TEST_CASE("what was at rest in the life before comes back at rest where it would fill the memory") {
  Replica origin{kLayer, kDefaultResolution};
  std::vector<CodedBlock> blocks;
  for (BlockOrdinal i = 0; i < 4000; ++i) blocks.push_back(block_with(i, 1, VoxelCode::free()));
  test::publish(origin, blocks);
  const auto restored_with = [&](std::size_t bytes_max) {
    std::vector<StoredBlock> stored;
    origin.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
      stored.push_back({block, found.history.latest(), found.codes});
      return true;
    });
    LayerBook book({4, 8192, bytes_max});
    REQUIRE(book.restore(
        std::make_unique<Replica>(kLayer, kDefaultResolution, origin.holdings(), stored)));
    CHECK(book.find(kLayer)->replica().digest().root() == origin.digest().root());
    CHECK(book.find(kLayer)->replica().known_voxels() == origin.known_voxels());
    return book.memory_bytes();
  };
  const std::size_t awake = restored_with(100'000'000);
  CHECK(restored_with(awake) < awake / 4);
}

TEST_CASE("a revision that is not stored is not told") {
  Books books;
  REQUIRE(books.book.add_own(books.origin));
  HeldLayer& own = *books.book.find(kLayer);
  CHECK(own.may_be_told());
  CHECK_FALSE(books.book.has_unstored());
  books.publish(1);
  CHECK_FALSE(own.may_be_told());
  const auto first = books.book.take_batch(1);
  REQUIRE(first.size() == 1);
  CHECK(first[0].own);
  CHECK(first[0].blocks.size() == 1);
  books.publish(2);
  books.book.on_stored(1);
  CHECK_FALSE(own.may_be_told());
  CHECK(books.book.take_batch(2).size() == 1);
  books.book.on_stored(2);
  CHECK(own.may_be_told());
}

TEST_CASE("what the store refused is not told, and comes again with the next batch") {
  Books books;
  REQUIRE(books.book.add_own(books.origin));
  HeldLayer& own = *books.book.find(kLayer);
  books.publish(1);
  CHECK(books.book.take_batch(1).at(0).blocks.size() == 1);
  books.book.on_refused(1);
  CHECK(books.book.has_unstored());
  books.publish(2, 101);
  CHECK(books.book.take_batch(2).at(0).blocks.size() == 2);
  books.book.on_stored(2);
  CHECK(own.may_be_told());
  CHECK_FALSE(books.book.has_unstored());
}

TEST_CASE("a copy that the store refused is stored whole with the next batch") {
  Books books;
  HeldLayer& copy = books.copy();
  books.publish(1);
  books.book.apply({}, copy, encoded(books.origin, 0).bytes);
  CHECK(books.book.take_batch(1).at(0).blocks.size() == 1);
  books.book.on_stored(1);
  books.publish(2, 101);
  books.book.apply({}, copy, encoded(books.origin, 1).bytes);
  (void)books.book.take_batch(2);
  books.book.on_refused(2);
  CHECK(copy.stored == Holdings(Revision{1}));
  const auto batch = books.book.take_batch(3);
  REQUIRE(batch.size() == 1);
  CHECK(batch[0].forgotten.size() == 1);
  CHECK(batch[0].blocks.size() == 2);
  books.book.on_stored(3);
  CHECK(copy.stored == copy.copy->holdings());
}

TEST_CASE("a block that changed and changed back is stored with its new revision") {
  Books books;
  HeldLayer& copy = books.copy();
  books.publish(1);
  books.book.apply({}, copy, encoded(books.origin, 0).bytes);
  CHECK(books.book.take_batch(1).at(0).blocks.at(0).changed_at == Revision{1});
  test::publish(books.origin, {block_with(100, 1, VoxelCode::occupied(3, false))});
  books.publish(1);
  books.book.apply({}, copy, encoded(books.origin, 1).bytes);
  const auto batch = books.book.take_batch(2);
  REQUIRE(batch.at(0).blocks.size() == 1);
  CHECK(batch[0].blocks[0].changed_at == Revision{3});
  CHECK(batch[0].holdings == Holdings(Revision{3}));
}

TEST_CASE("what is forgotten goes from the store, and what comes again after that is put") {
  Books books;
  HeldLayer& copy = books.copy();
  books.publish(1);
  books.book.apply({}, copy, encoded(books.origin, 0).bytes);
  (void)books.book.take_batch(1);
  REQUIRE(books.book.forget({}, copy, {0, 512}));
  CHECK(books.book.has_unstored());
  const auto emptied = books.book.take_batch(2);
  CHECK(emptied.at(0).blocks.empty());
  REQUIRE(emptied[0].forgotten.size() == 1);
  CHECK(emptied[0].forgotten[0].contains(100));
  CHECK(emptied[0].holdings.at(100) == Revision{});
  CHECK_FALSE(books.book.has_unstored());
  REQUIRE(books.book.forget({}, copy, {0, 512}));
  books.book.apply({}, copy, encoded(books.origin, 0).bytes);
  const auto again = books.book.take_batch(3);
  CHECK(again.at(0).forgotten.size() == 1);
  CHECK(again[0].blocks.size() == 1);
}

TEST_CASE("a restored copy goes on where its store was") {
  Books books;
  HeldLayer& copy = books.copy();
  books.publish(1);
  books.book.apply({}, copy, encoded(books.origin, 0).bytes);
  const auto batch = books.book.take_batch(1);
  LayerBook again({4, 8, 1 << 20});
  REQUIRE(again.restore(
      std::make_unique<Replica>(kLayer, kDefaultResolution, batch[0].holdings, batch[0].blocks)));
  HeldLayer& restored = *again.find(kLayer);
  CHECK_FALSE(again.has_unstored());
  CHECK(restored.replica().digest().root() == books.origin.digest().root());
  books.publish(2);
  CHECK(again.apply({}, restored, encoded(books.origin, 1).bytes).result == ApplyResult::kApplied);
  CHECK(again.has_unstored());
}

}  // namespace
}  // namespace warren::replication
