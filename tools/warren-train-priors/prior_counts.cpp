// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-train-priors/prior_counts.hpp"

#include <algorithm>
#include <cassert>

#include "core/layer/block_walk.hpp"
#include "core/layer/packet_body.hpp"
#include "tools/warren-train-priors/first_guess.hpp"

namespace warren {
namespace {

constexpr double kForgetting = 1.0 / 16.0;  // per bit, as adapt() does
constexpr double kGuessWeight = 0.8;        // of the first guess, in bits
// No prior is surer than this, in 256ths: another place may be another world.
constexpr int kLeast = 1;

}  // namespace

class PriorCounts::CountingDecoder {
 public:
  static constexpr bool kReads = true;

  CountingDecoder(std::vector<Count>& counts, std::span<const std::uint8_t> body)
      : counts_(counts), decoder_(diff_priors(), body) {}

  bool bit(std::size_t context, bool /*value*/) {
    const bool value = decoder_.bit(context, false);
    Count& count = counts_[context];
    (value ? count.set : count.clear) += count.next_weight;
    count.next_weight *= 1.0 - kForgetting;
    return value;
  }
  bool even_bit(bool /*value*/) { return decoder_.even_bit(false); }
  bool overrun() const { return decoder_.overrun(); }
  bool finished() const { return decoder_.finished(); }

 private:
  std::vector<Count>& counts_;
  ModelDecoder decoder_;
};

PriorCounts::PriorCounts() : counts_(diff_context::kCount) {}

void PriorCounts::add(std::span<const std::uint8_t> packet) {
  for (Count& count : counts_) count.next_weight = 1.0;
  const auto header = read_header(packet);
  assert(header.has_value());
  CountingDecoder decoder(counts_, packet.subspan(header->bytes));
  const auto blocks = packet_body::read_body(decoder, header->claim);
  assert(blocks.has_value());
  ++packets_;
  bytes_ += packet.size();
}

std::vector<std::uint8_t> PriorCounts::table() const {
  const DiffPriors guesses = first_guess();
  std::vector<std::uint8_t> table;
  table.reserve(counts_.size());
  for (std::size_t context = 0; context < counts_.size(); ++context) {
    const double guess = static_cast<double>(guesses[context]) / 65536.0;
    const Count& count = counts_[context];
    const double share =
        (count.set + kGuessWeight * guess) / (count.set + count.clear + kGuessWeight);
    const int byte = static_cast<int>(share * 256.0);
    table.push_back(static_cast<std::uint8_t>(std::clamp(byte, kLeast, 255 - kLeast)));
  }
  return table;
}

}  // namespace warren
