// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "daemon/store/store.hpp"

namespace warren::test {

// Small enough for checkpoints to come often.
inline StoreConfig small_config(const std::filesystem::path& file, const char* vfs = nullptr) {
  StoreConfig config;
  config.file = file;
  config.disk_bytes_max = std::uint64_t{64} << 20;
  config.checkpoint_bytes = std::uint64_t{64} << 10;
  config.vfs = vfs;
  return config;
}

inline Store::Opened opened(const StoreConfig& config) {
  auto store = Store::open(config);
  INFO((store ? std::string() : store.error().text));
  REQUIRE(store);
  return std::move(*store);
}

inline BatchResult commit_one(Store& store, const StoreBatch& batch) {
  const StoreBatch* const one = &batch;
  const auto report = store.commit({&one, 1});
  INFO((report ? std::string() : report.error().text));
  REQUIRE(report);
  return report->results.at(0);
}

}  // namespace warren::test
