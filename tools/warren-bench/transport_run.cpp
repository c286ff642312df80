// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/transport_run.hpp"

#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tools/warren-bench/transport_process.hpp"

namespace warren {
namespace {

using Clock = std::chrono::steady_clock;
using Time = Clock::time_point;
using std::chrono::microseconds;

constexpr auto kStartPatience = std::chrono::seconds(20);
constexpr double kQueueBytesLeast = 10 * 1500;
constexpr char kReceiverAddress[] = "10.77.0.2";
constexpr auto kRivalAhead = std::chrono::seconds(2);
constexpr std::uint16_t kRivalPort = 5001;

double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }
Clock::duration duration(double time_s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s));
}

struct Arrival {
  Time at;
  std::size_t bytes = 0;  // so far
};

// What the two sides have told.
struct Story {
  std::optional<Time> start;
  std::vector<Arrival> arrivals;
  std::optional<Time> blackout_end;
  std::chrono::microseconds sender_cpu{};
  std::chrono::microseconds receiver_cpu{};
  std::string problem;
  bool available = true;

  std::size_t bytes() const { return arrivals.empty() ? 0 : arrivals.back().bytes; }
};

std::vector<std::string> link_command(const TransportOptions& options, std::uint64_t seed,
                                      const TransportPrograms& programs) {
  const double queue_bytes =
      std::max(options.rate_bit_s / 8.0 * options.queue_ms / 1000.0, kQueueBytesLeast);
  const std::string loss = std::to_string(options.loss);
  std::vector<std::string> words{programs.link,
                                 "--tap",
                                 "--control",
                                 "--rate",
                                 std::to_string(options.rate_bit_s),
                                 "--delay-ms",
                                 std::to_string(options.rtt_ms / 2.0),
                                 "--queue-packets",
                                 "1000000",
                                 "--queue-bytes",
                                 std::to_string(static_cast<std::size_t>(queue_bytes)),
                                 "--seed",
                                 std::to_string(seed)};
  if (options.burst_packets) {
    words.insert(words.end(),
                 {"--burst-loss", loss, "--burst-packets", std::to_string(*options.burst_packets)});
  } else {
    words.insert(words.end(), {"--loss", loss});
  }
  return words;
}

struct PeerCommand {
  std::string kind;
  std::size_t bytes = 0;
  std::uint16_t port = 5000;
};

std::vector<std::string> words_of(const PeerCommand& peer, bool sends,
                                  const std::string& network_namespace,
                                  const TransportPrograms& programs) {
  std::vector<std::string> words{"ip", "netns", "exec", network_namespace, programs.bench};
  words.insert(words.end(),
               {"transport-peer", "--kind", peer.kind, "--address", kReceiverAddress, "--bytes",
                std::to_string(peer.bytes), "--port", std::to_string(peer.port)});
  if (sends) words.push_back("--send");
  return words;
}

// The namespaces' names, once the link is ready.
std::vector<std::string> namespaces_of(ChildProcess& link) {
  std::vector<std::string> names;
  while (const auto line = link.read_line(Clock::now() + kStartPatience)) {
    std::istringstream words(*line);
    std::string kind;
    std::string number;
    std::string name;
    words >> kind >> number >> name;
    if (kind == "node") names.push_back(name);
    if (kind == "ready") return names;
  }
  return {};
}

void hear(const std::string& line, Story& story) {
  std::int64_t time_us = 0;
  std::size_t bytes = 0;
  if (std::sscanf(line.c_str(), "start %" SCNd64, &time_us) == 1) {
    story.start = Time(microseconds(time_us));
  } else if (std::sscanf(line.c_str(), "at %" SCNd64 " %zu", &time_us, &bytes) == 2) {
    story.arrivals.push_back({Time(microseconds(time_us)), bytes});
  } else if (line.starts_with("unavailable ")) {
    story.available = false;
    story.problem = line.substr(12);
  } else if (line.starts_with("wrong ")) {
    story.problem = line.substr(6);
  }
}

// Another flow on the same link, from some time before until this object goes.
class Rival {
 public:
  Rival(const TransportOptions& options, const std::vector<std::string>& names,
        const TransportPrograms& programs)
      : command_{options.against.value_or(""), endless_bytes(options), kRivalPort},
        receiver_(words_of(command_, false, names[1], programs)) {
    if (receiver_.read_line(Clock::now() + kStartPatience) != "ready") {
      story_.problem = "the rival's receiver did not start";
      return;
    }
    sender_.emplace(words_of(command_, true, names[0], programs));
    const Time ahead = Clock::now() + kRivalAhead;
    while (Clock::now() < ahead) listen(ahead);
    if (story_.bytes() == 0) story_.problem = "the rival sent nothing";
  }

  // Its output must be read, or it stands still.
  void listen(Time until) {
    while (const auto line = receiver_.read_line(until)) hear(*line, story_);
    if (const auto line = sender_->read_line(Clock::now())) hear(*line, story_);
  }
  // Payload bytes that arrived between.
  double bytes(Time from, Time until) const {
    std::size_t before = 0;
    std::size_t after = 0;
    for (const Arrival& arrival : story_.arrivals) {
      if (arrival.at < from) before = arrival.bytes;
      if (arrival.at <= until) after = arrival.bytes;
    }
    return static_cast<double>(after - before);
  }
  const std::string& problem() const { return story_.problem; }

 private:
  static std::size_t endless_bytes(const TransportOptions& options) {
    return static_cast<std::size_t>(options.rate_bit_s / 8.0 * (time_limit_s(options) + 60.0));
  }

  PeerCommand command_;
  Story story_;
  ChildProcess receiver_;
  std::optional<ChildProcess> sender_;
};

// Follows both sides until the payload is there, the time is over or something breaks.
void follow(const TransportOptions& options, ChildProcess& link, ChildProcess& sender,
            ChildProcess& receiver, std::optional<Rival>& rival, Story& story) {
  const auto first = sender.read_line(Clock::now() + kStartPatience);
  hear(first.value_or("wrong the sender did not start"), story);
  const Time start = story.start.value_or(Clock::now());
  const Time end = start + duration(time_limit_s(options));
  std::vector<std::pair<Time, const char*>> switches;
  if (options.blackout_s > 0.0) {
    const Time off = start + duration(0.25 * ideal_s(options));
    switches = {{off, "off"}, {off + duration(options.blackout_s), "on"}};
  }
  while (story.problem.empty() && story.bytes() < options.bytes && Clock::now() < end) {
    if (receiver.has_ended()) story.problem = "the receiver ended";
    const Time next = switches.empty() ? end : std::min(end, switches.front().first);
    if (const auto line = receiver.read_line(std::min(next, Clock::now() + duration(1.0)))) {
      hear(*line, story);
    }
    if (rival) rival->listen(Clock::now());
    // The sender only speaks if something is wrong.
    if (const auto line = sender.read_line(Clock::now())) hear(*line, story);
    if (switches.empty() || Clock::now() < switches.front().first) continue;
    link.write_line(switches.front().second);
    if (switches.size() == 1) story.blackout_end = Clock::now();
    switches.erase(switches.begin());
  }
}

// Bytes that node 0 sent to node 1, or back.
double bytes_on_link(const nlohmann::json& stats, int from) {
  for (const auto& link : stats["links"]) {
    if (link["from"] == from) return link["offered_bytes"].get<double>();
  }
  return 0.0;
}

TransportRun judge(const TransportOptions& options, const Story& story,
                   const nlohmann::json& stats) {
  TransportRun run;
  run.problem = story.problem;
  run.available = story.available;
  run.link_late_ms_max = stats["late_ms"]["max"].get<double>();
  if (!story.start) return run;
  const auto bytes = static_cast<double>(story.bytes());
  double took_s = time_limit_s(options);
  if (story.bytes() >= options.bytes) {
    took_s = seconds(story.arrivals.back().at - *story.start);
    run.seconds = took_s;
  }
  const double arriving_bytes_s = options.rate_bit_s / 8.0 * (1.0 - options.loss);
  run.sender_cpu = seconds(story.sender_cpu) / took_s;
  run.receiver_cpu = seconds(story.receiver_cpu) / took_s;
  const double usable_s = took_s - (story.blackout_end ? options.blackout_s : 0.0);
  run.efficiency = bytes / (arriving_bytes_s * usable_s);
  if (bytes > 0.0) {
    run.oversend = bytes_on_link(stats, 0) * (1.0 - options.loss) / bytes;
    run.back_share = bytes_on_link(stats, 1) / bytes;
  }
  const bool dark = options.blackout_s > 0.0;
  if (dark && !story.blackout_end) return run;
  const Time from = dark ? *story.blackout_end : *story.start;
  for (const Arrival& arrival : story.arrivals) {
    if (arrival.at < from) continue;
    run.first_byte_s = seconds(arrival.at - from);
    break;
  }
  return run;
}

// What both got from the first one's start to its end.
void judge_shares(const TransportOptions& options, const Story& story, const Rival& rival,
                  TransportRun& run) {
  if (!rival.problem().empty()) run.problem = rival.problem();
  if (!story.start) return;
  const double took_s = run.seconds.value_or(time_limit_s(options));
  const double rival_bytes = rival.bytes(*story.start, *story.start + duration(took_s));
  run.rival_efficiency = rival_bytes / (options.rate_bit_s / 8.0 * (1.0 - options.loss) * took_s);
  const auto bytes = static_cast<double>(story.bytes());
  run.share = bytes + rival_bytes > 0.0 ? bytes / (bytes + rival_bytes) : 0.0;
}

TransportRun broken(const std::string& problem) {
  TransportRun run;
  run.problem = problem;
  return run;
}

}  // namespace

TransportRun run_transport(const TransportOptions& options, const std::string& peer,
                           std::uint64_t seed, const TransportPrograms& programs) {
  ChildProcess link(link_command(options, seed, programs));
  const auto names = namespaces_of(link);
  if (names.size() != 2) return broken("no link: see the message above");
  std::optional<Rival> rival;
  if (options.against) rival.emplace(options, names, programs);
  if (rival && !rival->problem().empty()) return broken(rival->problem());
  const PeerCommand command{peer, options.bytes};
  Story story;
  {
    ChildProcess receiver(words_of(command, false, names[1], programs));
    const auto ready = receiver.read_line(Clock::now() + kStartPatience);
    if (ready != "ready") return broken("the receiver did not start: " + ready.value_or(""));
    ChildProcess sender(words_of(command, true, names[0], programs));
    follow(options, link, sender, receiver, rival, story);
    link.write_line("stats");
    story.sender_cpu = sender.kill();
    story.receiver_cpu = receiver.kill();
  }
  const auto stats = link.read_line(Clock::now() + kStartPatience);
  link.write_line("quit");
  while (link.read_line(Clock::now() + kStartPatience)) {
  }
  link.wait();
  if (!stats) return broken("the link ended");
  TransportRun run = judge(options, story, nlohmann::json::parse(*stats));
  if (rival) judge_shares(options, story, *rival, run);
  return run;
}

}  // namespace warren
