// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <tl/expected.hpp>

#include "daemon/store/store_error.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace warren {

// One connection to an SQLite file. What fails is remembered, the first of it, and everything after
// does nothing until clear_failure(): a run of statements is written without a check after each,
// and asks once at its end. One thread.
class Database {
 public:
  // Makes the file if there is none. `vfs` names the file system of SQLite to use; null: the usual.
  static tl::expected<Database, StoreFailure> open(const std::filesystem::path& file,
                                                   const char* vfs);

  bool ok() const { return !failure_; }
  const std::optional<StoreFailure>& failure() const { return failure_; }
  void clear_failure() { failure_.reset(); }
  void fail(StoreError error, const std::string& text);

  bool run(const char* sql);
  // The first column of the first row; 0 if there is none.
  std::int64_t number(const char* sql);
  std::string text(const char* sql);
  // Ends a transaction that failed, if one is open.
  void roll_back();

  // Counts the pages in the write-ahead log from here on. To be called after `wal_autocheckpoint`.
  void watch_log();
  std::int64_t log_pages() const { return *log_pages_; }
  // Moves the log's pages into the file. What fails is told here alone.
  std::optional<StoreFailure> checkpoint();

 private:
  friend class Statement;
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  explicit Database(sqlite3* connection) : connection_(connection) {}
  void fail_by(int code);

  std::unique_ptr<std::int64_t> log_pages_ = std::make_unique<std::int64_t>(0);
  std::unique_ptr<sqlite3, Close> connection_;
  std::optional<StoreFailure> failure_;
};

// A prepared statement. It must not outlive its database, nor may that move.
class Statement {
 public:
  Statement(Database& database, const char* sql);

  Statement& bind(int parameter, std::int64_t value);
  // The bytes must live until the last step.
  Statement& bind(int parameter, std::span<const std::uint8_t> bytes);
  // Whether there is a row. After the last one, or a failure, it is ready to be bound anew.
  bool step();
  // For who stops before the last row.
  void reset();

  std::int64_t number(int column) const;
  // Valid until the next step.
  std::span<const std::uint8_t> bytes(int column) const;
  std::string text(int column) const;

 private:
  struct Finalise {
    void operator()(sqlite3_stmt* statement) const;
  };
  Database& database_;
  std::unique_ptr<sqlite3_stmt, Finalise> statement_;
};

}  // namespace warren
