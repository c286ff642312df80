// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "warren/control.pb.h"
#include "warren/ingest.pb.h"

namespace warren {

// A blocking client of a unix socket that can also misbehave. A wait of more than a minute fails.
class TestClient {
 public:
  explicit TestClient(const std::filesystem::path& socket);
  ~TestClient() { close(); }
  TestClient(TestClient&& other) noexcept;
  TestClient& operator=(TestClient&&) = delete;

  // False if the daemon has closed.
  bool write(const std::string& bytes);
  // Nothing at the end of the stream.
  std::optional<std::string> read_frame();
  bool is_at_end() { return !read_frame(); }
  void close();
  // Closes for writing only.
  void end_writing();

  std::optional<ingest::IngestReply> read_reply();
  // Of the next reply, which must be one.
  ingest::ScanReceipt read_receipt();
  control::Response ask(const control::Request& request);

 private:
  bool read_exactly(char* bytes, std::size_t count);

  int descriptor_ = -1;
};

// Greets and has been welcomed.
TestClient greeted_client(const std::filesystem::path& socket);

}  // namespace warren
