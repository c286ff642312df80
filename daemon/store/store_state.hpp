// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "daemon/store/layer_table.hpp"
#include "daemon/store/log_table.hpp"
#include "daemon/store/named_table.hpp"
#include "daemon/store/self_table.hpp"
#include "daemon/store/store.hpp"
#include "daemon/store/store_files.hpp"

namespace warren {

// Precondition: the database is prepared. Tables refer to it, so it stays where it is.
struct Store::State {
  State(const StoreConfig& with, Database&& prepared)
      : config(with),
        database(std::move(prepared)),
        mark(with.file),
        store_rows(database, "store"),
        layers(database),
        selves(database),
        log(database),
        named(database) {}

  // What is held in memory, read anew from the file.
  void load();
  std::int64_t pages_max() const;
  std::uint64_t used_bytes();

  FileHandle lock;  // let go of last
  StoreConfig config;
  Database database;
  CommitMark mark;
  RowTable store_rows;
  StoreRow row;
  LayerTable layers;
  SelfTable selves;
  LogTable log;
  NamedTable named;
  bool must_load = false;   // a transaction failed: memory may be ahead of the file
  bool needs_room = false;  // the last commit found none
  bool is_behind = false;   // as a batch said
  std::uint64_t checkpoints_failed = 0;
};

}  // namespace warren
