// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <variant>
#include <vector>

#include <tl/expected.hpp>

#include "tools/link/link_config.hpp"

namespace warren {

// How one direction changes over time.
struct LinkTrace {
  std::vector<RateStep> rates;  // none: the rate stays as configured
  std::vector<ChannelStep> steps;
};

// The directions between named nodes, in the order in which the names first appear. Where a link is
// dead the rate goes on as it was: what is sent is lost.
struct RadioTraceFile {
  struct Link {
    std::size_t from = 0;
    std::size_t to = 0;
    LinkTrace trace;
  };
  std::vector<std::string> names;
  std::vector<Link> links;
};

using TraceFile = std::variant<LinkTrace, RadioTraceFile, Opportunities, LossPattern>;

// By its first line the file is one of
//   time_s,rate_bit_s,loss,delay_ms      one direction; a field that is empty stays as configured
//   time_s,from,to,loss,rate_bit_s       warren-sim radio
//   a whole number                       mahimahi: a line per opportunity, in ms
//   two whole numbers                    Rutgers ORBIT: number and RSSI of each packet received,
//                                        one was sent every 100 ms
// and an empty file is a Rutgers link on which nothing came. Or what is wrong, and in which line.
tl::expected<TraceFile, std::string> read_trace(std::istream& in);
tl::expected<TraceFile, std::string> read_trace_file(const std::filesystem::path& path);

// Precondition: not a RadioTraceFile.
void apply(const TraceFile& trace, LinkConfig& link);
void apply(const LinkTrace& trace, LinkConfig& link);

}  // namespace warren
