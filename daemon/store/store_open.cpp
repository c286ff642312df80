// SPDX-License-Identifier: Apache-2.0
#include <cassert>
#include <chrono>
#include <string>

#include "daemon/store/schema.hpp"
#include "daemon/store/store_state.hpp"

namespace warren {
namespace {

using Clock = std::chrono::steady_clock;

void set_limits(const StoreConfig& config, std::int64_t pages_max, Database& database) {
  const auto set = [&](const char* name, std::int64_t value) {
    database.text(("PRAGMA " + std::string(name) + " = " + std::to_string(value)).c_str());
  };
  set("max_page_count", pages_max);
  set("cache_size", -static_cast<std::int64_t>(config.cache_bytes / 1024));
  set("journal_size_limit", static_cast<std::int64_t>(config.checkpoint_bytes * 2));
}

}  // namespace

void Store::State::load() {
  const auto bytes = store_rows.get(0);
  const auto read = bytes ? decode_store_row(*bytes) : std::nullopt;
  if (read)
    row = *read;
  else
    database.fail(StoreError::kCorrupt, "the row of the store itself is missing");
  layers.load();
  selves.load();
  log.load();
  named.load();
}

std::int64_t Store::State::pages_max() const {
  assert(config.disk_bytes_max >= 4 * kLogsMax * config.checkpoint_bytes);
  return static_cast<std::int64_t>((config.disk_bytes_max - kLogsMax * config.checkpoint_bytes) /
                                   kPageBytes);
}

namespace {

// Everything is read once: what a start hands out is sound.
void check(Store::State& state, StartReport& report) {
  check_pages(state.database);
  state.load();
  report.blocks = state.layers.verify() + state.selves.verify();
  report.items = state.log.verify();
  report.layers = state.layers.rows().size();
  report.self_layers = state.selves.heads().size();
}

// Acknowledged commits are gone: whatever numbers they used must not be used again.
void close_if_rolled_back(Store::State& state, StartReport& report) {
  const auto last = state.mark.last(state.row.store);
  if (!last || *last <= state.row.commits) return;
  report.rolled_back = true;
  report.commits_lost = *last - state.row.commits;
  state.database.run("BEGIN IMMEDIATE");
  state.layers.close_own();
  state.row.commits = *last + 1;
  state.store_rows.put(0, encode_store_row(state.row));
  state.database.run("COMMIT");
}

}  // namespace

tl::expected<Store::Opened, StoreFailure> Store::open_once(const StoreConfig& config) {
  StartReport report;
  report.recovered = log_bytes(config.file) > 0;
  auto database = Database::open(config.file, config.vfs);
  if (!database) return tl::unexpected(database.error());
  report.fresh = prepare(*database);
  if (!database->ok()) return tl::unexpected(*database->failure());
  auto state = std::make_unique<State>(config, std::move(*database));
  set_limits(config, state->pages_max(), state->database);
  check(*state, report);
  if (state->database.ok()) close_if_rolled_back(*state, report);
  if (!state->database.ok()) return tl::unexpected(*state->database.failure());
  state->mark.note(state->row.store, state->row.commits);
  report.bytes = state->used_bytes();
  sync_folder_of(config.file);
  return Opened{Store(std::move(state)), report};
}

tl::expected<Store::Opened, StoreFailure> Store::open(const StoreConfig& config) {
  const Clock::time_point start = Clock::now();
  auto lock = lock_store(config.file);
  if (!lock) return tl::unexpected(lock.error());
  auto opened = open_once(config);
  if (!opened && opened.error().error == StoreError::kCorrupt) {
    const auto kept = set_aside(config.file);
    if (!kept) return tl::unexpected(kept.error());
    const StartReport::MovedAside moved{*kept, opened.error().text};
    opened = open_once(config);
    if (opened) opened->report.moved_aside = moved;
  }
  if (!opened) {
    const StoreFailure& failure = opened.error();
    return tl::unexpected(StoreFailure{failure.error, config.file.string() + ": " + failure.text});
  }
  opened->store.state_->lock = std::move(*lock);
  opened->report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return opened;
}

}  // namespace warren
