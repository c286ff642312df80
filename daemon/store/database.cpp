// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/database.hpp"

#include <sqlite3.h>

namespace warren {
namespace {

StoreError error_of(int code) {
  switch (code & 0xFF) {
    case SQLITE_FULL:
      return StoreError::kDiskFull;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return StoreError::kCorrupt;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return StoreError::kInUse;
    default:
      return StoreError::kIo;
  }
}

}  // namespace

const char* text_of(StoreError error) {
  switch (error) {
    case StoreError::kInUse:
      return "in use by another process";
    case StoreError::kNewerVersion:
      return "written by a later release";
    case StoreError::kNotAStore:
      return "not a store of Warren";
    case StoreError::kCeiling:
      return "the ceiling of disk space is reached";
    case StoreError::kDiskFull:
      return "disk full";
    case StoreError::kIo:
      return "input/output error";
    case StoreError::kCorrupt:
      return "corrupt";
  }
  return "unknown error";
}

void Database::Close::operator()(sqlite3* connection) const { sqlite3_close_v2(connection); }
void Statement::Finalise::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

tl::expected<Database, StoreFailure> Database::open(const std::filesystem::path& file,
                                                    const char* vfs) {
  sqlite3* connection = nullptr;
  // Without mutexes: one thread at a time uses a connection.
  const int code = sqlite3_open_v2(
      file.c_str(), &connection,
      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE,
      vfs);
  Database database(connection);
  if (code != SQLITE_OK) {
    database.fail_by(code);
    return tl::unexpected(*database.failure());
  }
  return database;
}

void Database::fail(StoreError error, const std::string& text) {
  if (!failure_) failure_ = {error, text};
}

void Database::fail_by(int code) {
  const char* const said =
      connection_ ? sqlite3_errmsg(connection_.get()) : sqlite3_errstr(code & 0xFF);
  fail(error_of(code), std::string(said) + " (SQLite " + std::to_string(code) + ")");
}

bool Database::run(const char* sql) {
  Statement statement(*this, sql);
  while (statement.step()) {
  }
  return ok();
}

std::int64_t Database::number(const char* sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.number(0) : 0;
}

std::string Database::text(const char* sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.text(0) : std::string();
}

void Database::roll_back() {
  if (sqlite3_get_autocommit(connection_.get()) != 0) return;
  sqlite3_exec(connection_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Database::watch_log() {
  const auto count = [](void* pages, sqlite3*, const char*, int now) {
    *static_cast<std::int64_t*>(pages) = now;
    return SQLITE_OK;
  };
  sqlite3_wal_hook(connection_.get(), count, log_pages_.get());
}

std::optional<StoreFailure> Database::checkpoint() {
  const int code = sqlite3_wal_checkpoint_v2(connection_.get(), nullptr, SQLITE_CHECKPOINT_PASSIVE,
                                             nullptr, nullptr);
  if (code == SQLITE_OK) {
    *log_pages_ = 0;
    return std::nullopt;
  }
  return StoreFailure{error_of(code), sqlite3_errmsg(connection_.get())};
}

Statement::Statement(Database& database, const char* sql) : database_(database) {
  if (!database.ok()) return;
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v3(database.connection_.get(), sql, -1, 0, &statement, nullptr);
  statement_.reset(statement);
  if (code != SQLITE_OK) database.fail_by(code);
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  if (statement_) sqlite3_bind_int64(statement_.get(), parameter, value);
  return *this;
}

Statement& Statement::bind(int parameter, std::span<const std::uint8_t> bytes) {
  if (statement_) {
    sqlite3_bind_blob64(statement_.get(), parameter, bytes.data(), bytes.size(), SQLITE_STATIC);
  }
  return *this;
}

bool Statement::step() {
  if (!statement_ || !database_.ok()) return false;
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) database_.fail_by(code);
  reset();
  return false;
}

void Statement::reset() {
  if (!statement_) return;
  sqlite3_reset(statement_.get());
  sqlite3_clear_bindings(statement_.get());
}

std::int64_t Statement::number(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::span<const std::uint8_t> Statement::bytes(int column) const {
  const auto* const data =
      static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

std::string Statement::text(int column) const {
  const unsigned char* const text = sqlite3_column_text(statement_.get(), column);
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

}  // namespace warren
