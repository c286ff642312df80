// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/store.hpp"

#include <utility>

#include "daemon/store/schema.hpp"
#include "daemon/store/store_state.hpp"

namespace warren {
namespace {

// What a reader made, unless the file failed it.
template <typename Value>
tl::expected<Value, StoreFailure> unless_failed(Database& database, Value value) {
  if (!database.ok()) return tl::unexpected(*database.failure());
  return value;
}

}  // namespace

const char* text_of(BatchResult result) {
  switch (result) {
    case BatchResult::kStored:
      return "stored";
    case BatchResult::kRevisionReused:
      return "a revision of an own layer is not above the stored one";
    case BatchResult::kLayerClosed:
      return "an own layer is closed, because the store lost commits";
    case BatchResult::kHoldingsLowered:
      return "less of a layer is held than before";
    case BatchResult::kSequenceReused:
      return "an own item's number is taken";
    case BatchResult::kTooManyItems:
      return "too many items are kept";
    case BatchResult::kUnsound:
      return "the batch contradicts itself or the store";
    case BatchResult::kGivenUp:
      return "not stored before the end";
  }
  return "unknown result";
}

Store::Store(std::unique_ptr<State> state) : state_(std::move(state)) {}
Store::~Store() = default;
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;

std::vector<StoredLayer> Store::layers() const {
  std::vector<StoredLayer> layers;
  for (LayerRow& row : state_->layers.rows()) layers.push_back({std::move(row.head), row.closed});
  return layers;
}

tl::expected<Replica, StoreFailure> Store::replica(const LayerHead& head) {
  const std::vector<StoredBlock> blocks = state_->layers.blocks(head.id);
  if (!state_->database.ok()) return tl::unexpected(*state_->database.failure());
  Replica replica(head.id, head.resolution, head.holdings, blocks);
  replica.pose() = head.pose;
  return replica;
}

std::vector<SelfLayerHead> Store::self_layers() const { return state_->selves.heads(); }

tl::expected<SelfMap, StoreFailure> Store::self_map(const SelfLayerHead& head) {
  SelfMap map(head.config);
  const bool filled = state_->selves.fill(head, map);
  if (!state_->database.ok() || !filled) {
    return tl::unexpected(state_->database.failure().value_or(
        StoreFailure{StoreError::kCorrupt, "a block of the self-map makes no sense"}));
  }
  return map;
}

tl::expected<std::vector<LogItem>, StoreFailure> Store::items() {
  return unless_failed(state_->database, state_->log.items());
}

tl::expected<std::map<std::string, std::uint64_t>, StoreFailure> Store::counters() {
  return unless_failed(state_->database, state_->named.counters());
}

tl::expected<std::map<std::string, std::vector<std::uint8_t>>, StoreFailure> Store::states() {
  return unless_failed(state_->database, state_->named.states());
}

std::uint64_t Store::State::used_bytes() {
  const std::int64_t pages =
      database.number("PRAGMA page_count") - database.number("PRAGMA freelist_count");
  return static_cast<std::uint64_t>(pages) * kPageBytes;
}

StoreUsage Store::usage() {
  State& s = *state_;
  const auto pages = static_cast<std::uint64_t>(s.database.number("PRAGMA page_count"));
  return {pages * kPageBytes, s.used_bytes(), log_bytes(s.config.file), s.row.commits,
          s.checkpoints_failed};
}

}  // namespace warren
