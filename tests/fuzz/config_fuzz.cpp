// SPDX-License-Identifier: Apache-2.0
// A config file: what is accepted loads back equal from both of its printed forms; what is refused
// has its reasons, each of one line without control characters that begins with file and line.
#include <algorithm>
#include <cassert>

#include "daemon/config/load.hpp"
#include "daemon/config/print.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace warren::fuzz {
namespace {

void check_accepted(const Config& config) {
  for (const std::string& printed : {print_config(config), print_sample(config)}) {
    const auto again = parse_config(printed, "printed");
    assert(again && *again == config);
  }
  const ConfigChanges changes = compare_configs(config, reloaded(Config{}, config));
  assert(changes.effective.empty());
}

void check_refused(const ConfigFaults& faults) {
  assert(!faults.empty());
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
  for (const std::string& fault : faults) {
    assert(fault.compare(0, 5, "file:") == 0 && fault[5] >= '1' && fault[5] <= '9');
    assert(std::none_of(fault.begin(), fault.end(), is_control));
  }
}

}  // namespace
}  // namespace warren::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren::fuzz;
  const auto config = warren::parse_config(std::string(text_of(data, size)), "file");
  if (config) {
    check_accepted(*config);
  } else {
    check_refused(config.error());
  }
  return 0;
}
