// SPDX-License-Identifier: Apache-2.0
// A trace of a link: whatever is read keeps what the model demands of it, and packets pass or are
// counted as dropped.
#include <cassert>
#include <sstream>
#include <string>
#include <variant>

#include "tests/fuzz/fuzz_input.hpp"
#include "tools/link/link_model.hpp"
#include "tools/link/trace_files.hpp"

namespace warren::fuzz {
namespace {

constexpr int kPackets = 40;
constexpr std::size_t kLinksMax = 20;

// Packets at rising times, from the start to far beyond the trace's end.
void send_over(const LinkConfig& link) {
  LinkModelConfig config;
  config.link = link;
  LinkModel model(config);
  MeshTime now{};
  std::uint64_t arrived = 0;
  const auto take_all = [&] {
    while (const auto delivery = model.poll(now)) {
      assert(delivery->at <= now);
      ++arrived;
    }
  };
  for (int i = 0; i < kPackets; ++i) {
    model.send(now, {0, 1, 1500, {}});
    take_all();
    now += Duration{std::int64_t{1} << i};
  }
  take_all();
  const LinkCounts& counts = model.counts(0, 1);
  assert(counts.offered_packets == kPackets);
  assert(arrived == counts.delivered_packets && arrived <= kPackets);
}

}  // namespace
}  // namespace warren::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  std::istringstream in{std::string(fuzz::text_of(data, size))};
  const auto trace = read_trace(in);
  if (!trace) {
    assert(!trace.error().empty());
    return 0;
  }
  LinkConfig link;
  if (const auto* radio = std::get_if<RadioTraceFile>(&*trace)) {
    std::size_t used = 0;
    for (const RadioTraceFile::Link& one : radio->links) {
      assert(one.from < radio->names.size() && one.to < radio->names.size());
      if (++used > fuzz::kLinksMax) break;
      LinkConfig of_one;
      apply(one.trace, of_one);
      fuzz::send_over(of_one);
    }
  } else {
    apply(*trace, link);
    fuzz::send_over(link);
  }
  return 0;
}
