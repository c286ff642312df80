// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-link/options.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/link/trace_files.hpp"
#include "tools/world/number_text.hpp"

namespace warren {
namespace {

using Error = tl::unexpected<std::string>;

Duration milliseconds(double ms) { return Duration(std::llround(ms * 1000.0)); }

struct Override {
  StationIndex from = 0;
  StationIndex to = 0;
  LinkSettings settings;
};

std::optional<std::string> set(LinkSettings& settings, std::string_view field) {
  const std::size_t equals = field.find('=');
  const std::string_view name = field.substr(0, equals);
  const auto found = std::find_if(kLinkSettings.begin(), kLinkSettings.end(),
                                  [&](const LinkSetting& setting) { return name == setting.name; });
  if (found == kLinkSettings.end()) return "no setting " + std::string(name);
  const auto value =
      equals == std::string_view::npos ? std::nullopt : number_in<double>(field.substr(equals + 1));
  if (!value || !(*value >= found->least && *value <= found->most)) {
    return "no value for " + std::string(name) + " in " + std::string(field);
  }
  settings.*(found->value) = *value;
  return {};
}

tl::expected<Override, std::string> read_override(std::string_view text,
                                                  const LinkOptions& options) {
  Override result{.settings = options.link};
  for (int field = 0; !text.empty(); ++field) {
    const std::size_t end = std::min(text.find(','), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (field >= 2) {
      if (const auto error = set(result.settings, word)) return Error("--link: " + *error);
    } else {
      const auto node = number_in<StationIndex>(word);
      if (!node || *node >= options.nodes) return Error("--link: no node " + std::string(word));
      (field == 0 ? result.from : result.to) = *node;
    }
  }
  if (result.from == result.to) return Error("--link wants FROM,TO,NAME=VALUE,..");
  return result;
}

LinkConfig config_of(const LinkSettings& settings, const LinkOptions& options) {
  LinkConfig link;
  if (settings.rate_bit_s > 0.0) link.capacity = Capacity(settings.rate_bit_s);
  if (settings.mtu_bytes > 0.0) link.mtu_bytes = static_cast<std::size_t>(settings.mtu_bytes);
  if (settings.burst_loss > 0.0) {
    link.burst_loss = BurstLoss{settings.burst_loss, settings.burst_packets};
  }
  link.delay = milliseconds(settings.delay_ms);
  link.jitter = milliseconds(settings.jitter_ms);
  link.jitter_reorders = settings.jitter_reorders != 0.0;
  link.loss = settings.loss;
  link.reorder = settings.reorder;
  link.reorder_by = milliseconds(settings.reorder_ms);
  link.duplicate = settings.duplicate;
  link.corrupt = settings.corrupt;
  for (const auto& [from, until] : options.blackouts_s) {
    link.blackouts.push_back({milliseconds(1000.0 * from), milliseconds(1000.0 * until)});
  }
  return link;
}

QueueLimit queue_of(const LinkOptions& options) {
  QueueLimit queue;
  queue.packets = options.queue_packets;
  if (options.queue_bytes) queue.bytes = *options.queue_bytes;
  if (options.queue_ms) queue.time = milliseconds(*options.queue_ms);
  return queue;
}

using Links = std::vector<std::vector<LinkConfig>>;  // by sender, then receiver

std::optional<std::string> apply_trace(const std::string& path, const LinkOptions& options,
                                       bool back_only, Links& links) {
  const auto trace = read_trace_file(path);
  if (!trace) return trace.error();
  const auto* radio = std::get_if<RadioTraceFile>(&*trace);
  if (radio == nullptr) {
    for (auto& row : links) {
      for (LinkConfig& link : row) {
        if (!back_only || &link == &links[1][0]) apply(*trace, link);
      }
    }
    return {};
  }
  if (back_only) return path + " has all directions: it cannot be one";
  if (radio->names.size() != options.nodes) {
    return path + " has " + std::to_string(radio->names.size()) + " nodes: say so with --nodes";
  }
  for (const auto& link : radio->links) apply(link.trace, links[link.from][link.to]);
  return {};
}

std::optional<std::string> unsound_blackout(const LinkOptions& options) {
  double last = 0.0;
  for (const auto& [from, until] : options.blackouts_s) {
    if (!(from >= last && until > from)) return "blackouts must rise and not overlap";
    last = until;
  }
  return {};
}

}  // namespace

tl::expected<LinkModel, std::string> make_model(const LinkOptions& options, MeshTime start) {
  if (const auto error = unsound_blackout(options)) return Error(*error);
  Links links(options.nodes,
              std::vector<LinkConfig>(options.nodes, config_of(options.link, options)));
  for (const std::string& text : options.overrides) {
    const auto one = read_override(text, options);
    if (!one) return Error(one.error());
    links[one->from][one->to] = config_of(one->settings, options);
  }
  for (const bool back : {false, true}) {
    const std::string& path = back ? options.trace_back : options.trace;
    if (path.empty()) continue;
    if (const auto error = apply_trace(path, options, back, links)) return Error(*error);
  }
  LinkModel model({.stations = options.nodes,
                   .shared_airtime = options.shared_airtime,
                   .queue = queue_of(options),
                   .link = {},
                   .seed = options.seed,
                   .start = start});
  for (std::size_t from = 0; from < options.nodes; ++from) {
    for (std::size_t to = 0; to < options.nodes; ++to) {
      model.set_link(start, static_cast<StationIndex>(from), static_cast<StationIndex>(to),
                     links[from][to]);
    }
  }
  return model;
}

}  // namespace warren
