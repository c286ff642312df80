// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace warren {

// What a file's keys and values bring along must neither break a fault's line nor steer a terminal.
inline std::string one_line(std::string text) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

// Collects what is wrong in a config file, and where.
class FaultList {
 public:
  explicit FaultList(std::string file) : file_(std::move(file)) {}

  // The line on which a key stands, from 1; later faults of that key point there.
  void set_line(const std::string& key, int line) { lines_[key] = line; }
  void add(const std::string& key, const std::string& what) {
    const auto line = lines_.find(key);
    add_at(line == lines_.end() ? 1 : line->second, key + ": " + what);
  }
  void add_at(int line, const std::string& what) {
    if (faults_.size() < kMaxFaults) faults_.emplace_back(line, one_line(what));
  }

  bool empty() const { return faults_.empty(); }
  std::vector<std::string> in_line_order() {
    std::stable_sort(faults_.begin(), faults_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::string> texts;
    for (const auto& [line, what] : faults_) {
      texts.push_back(file_ + ":" + std::to_string(line) + ": " + what);
    }
    return texts;
  }

 private:
  static constexpr std::size_t kMaxFaults = 100;

  std::string file_;
  std::map<std::string, int> lines_;
  std::vector<std::pair<int, std::string>> faults_;
};

}  // namespace warren
