// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/schema.hpp"

#include <array>
#include <string>

#include "core/exchange/byte_fields.hpp"
#include "daemon/store/head_bytes.hpp"
#include "daemon/store/row_table.hpp"

namespace warren {
namespace {

constexpr std::array kTables{"store",      "layer",    "layer_block", "self_layer",
                             "self_block", "log_item", "log_bytes",   "named"};

void create_tables(Database& database) {
  for (const char* const table : kTables) {
    database.run(
        (std::string("CREATE TABLE ") + table + " (key INTEGER PRIMARY KEY, data BLOB NOT NULL)")
            .c_str());
  }
}

// The n-th brings version n to n + 1; version 0 is the empty file.
using Migration = void (*)(Database&);
constexpr std::array<Migration, kSchemaVersion> kMigrations{create_tables};

// Of the sealed row, not of the header, whose bytes nothing protects; 0 if there is none.
std::int64_t sealed_version(Database& database) {
  if (database.number("SELECT count(*) FROM sqlite_schema WHERE name = 'store'") == 0) return 0;
  RowTable rows(database, "store");
  const auto row = rows.get(0);
  return row ? ByteReader(*row).number<std::uint32_t>() : 0;
}

void judge(Database& database, std::int64_t version, std::int64_t application) {
  const std::int64_t sealed = sealed_version(database);
  if (!database.ok()) return;
  if (sealed == 0 && application != kApplicationId) {
    database.fail(StoreError::kNotAStore, "the file is a database, but not a store of Warren");
  } else if (sealed != version || application != kApplicationId) {
    database.fail(StoreError::kCorrupt, "the file's header is damaged");
  } else if (version > kSchemaVersion) {
    database.fail(StoreError::kNewerVersion,
                  "the file has schema version " + std::to_string(version) +
                      ", this release knows up to " + std::to_string(kSchemaVersion));
  }
}

void migrate(Database& database, std::int64_t version) {
  if (version == kSchemaVersion) return;
  database.run("BEGIN IMMEDIATE");
  for (; version < kSchemaVersion; ++version)
    kMigrations[static_cast<std::size_t>(version)](database);
  RowTable rows(database, "store");
  const auto row = rows.get(0);
  StoreRow store = row ? decode_store_row(*row).value_or(StoreRow{}) : StoreRow{};
  if (store.store == 0) {
    store.store = static_cast<std::uint64_t>(database.number("SELECT random()")) | 1;
  }
  store.schema = static_cast<std::uint32_t>(kSchemaVersion);
  rows.put(0, encode_store_row(store));
  database.run(("PRAGMA application_id = " + std::to_string(kApplicationId)).c_str());
  database.run(("PRAGMA user_version = " + std::to_string(kSchemaVersion)).c_str());
  if (!database.run("COMMIT")) database.roll_back();
}

}  // namespace

bool prepare(Database& database) {
  // Before anything is read: one process alone, and no shared memory beside the file.
  database.run("PRAGMA locking_mode = EXCLUSIVE");
  const std::int64_t tables = database.number("SELECT count(*) FROM sqlite_schema");
  const std::int64_t version = database.number("PRAGMA user_version");
  const std::int64_t application = database.number("PRAGMA application_id");
  const bool fresh = tables == 0 && version == 0 && application == 0;
  if (database.ok() && !fresh) judge(database, version, application);
  if (!database.ok()) return false;
  if (database.text("PRAGMA journal_mode = WAL") != "wal") {
    database.fail(StoreError::kIo, "the file system cannot keep a write-ahead log");
  }
  database.run("PRAGMA synchronous = FULL");
  database.run("PRAGMA wal_autocheckpoint = 0");
  database.watch_log();
  migrate(database, version);
  return fresh;
}

void check_pages(Database& database) {
  const std::string found = database.text("PRAGMA quick_check(1)");
  if (database.ok() && found != "ok") database.fail(StoreError::kCorrupt, found);
}

}  // namespace warren
