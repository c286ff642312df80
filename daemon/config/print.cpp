// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/print.hpp"

#include <sstream>

#include "daemon/config/value.hpp"

namespace warren {
namespace {

enum class Comments { kNone, kAll };

constexpr std::size_t kLineWidth = 96;

template <typename Owner>
ValueRule rule_of(const Key<Owner>& key) {
  return {key.limits, key.choices};
}

std::vector<std::string> split_at_dots(std::string_view name) {
  std::vector<std::string> parts;
  std::istringstream stream{std::string(name)};
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

// Writes the keys of one owner. The first line of a list's item begins with a dash.
template <typename Owner>
class OwnerPrinter {
 public:
  OwnerPrinter(std::ostringstream& out, Comments comments, std::size_t indent)
      : out_(out), comments_(comments), indent_(indent) {}

  // The slots of a const owner are only read. `after` is called behind each key, with its name.
  template <typename After>
  void print(const Owner& owner, std::span<const Key<Owner>> keys, bool is_item,
             const After& after) {
    Owner copy = owner;
    Owner defaults;
    std::vector<std::string> sections;
    for (const Key<Owner>& key : keys) {
      std::vector<std::string> parts = split_at_dots(key.name);
      const std::string leaf = parts.back();
      parts.pop_back();
      open_sections(sections, parts);
      sections = parts;
      const std::size_t depth = indent_ + 2 * sections.size();
      const bool dashed = is_item && &key == &keys.front();
      if (comments_ == Comments::kAll) comment(key, defaults, depth - (dashed ? 2 : 0));
      out_ << std::string(depth - (dashed ? 2 : 0), ' ') << (dashed ? "- " : "") << leaf << ": "
           << print_value(key.slot(copy), rule_of(key)) << "\n";
      after(key.name);
    }
  }

 private:
  void open_sections(const std::vector<std::string>& open, const std::vector<std::string>& wanted) {
    std::size_t common = 0;
    while (common < open.size() && common < wanted.size() && open[common] == wanted[common]) {
      ++common;
    }
    for (std::size_t i = common; i < wanted.size(); ++i) {
      if (comments_ == Comments::kAll && i == 0 && indent_ == 0) out_ << "\n";
      out_ << std::string(indent_ + 2 * i, ' ') << wanted[i] << ":\n";
    }
  }

  void comment(const Key<Owner>& key, Owner& defaults, std::size_t depth) {
    const Slot slot = key.slot(defaults);
    std::string facts = "Allowed: " + describe_allowed(slot, rule_of(key)) + ". ";
    facts += "Default: " + print_value(slot, rule_of(key)) + ". ";
    facts += key.takes == Takes::kReload ? "A reload is enough." : "A change needs a restart.";
    comment_lines(std::string(key.doc), depth);
    comment_lines(facts, depth);
  }

  void comment_lines(const std::string& text, std::size_t depth) {
    const std::string begin = std::string(depth, ' ') + "#";
    std::istringstream words(text);
    std::string line = begin;
    for (std::string word; words >> word;) {
      if (line.size() + 1 + word.size() > kLineWidth) {
        out_ << line << "\n";
        line = begin;
      }
      line += " " + word;
    }
    out_ << line << "\n";
  }

  std::ostringstream& out_;
  Comments comments_;
  std::size_t indent_;
};

template <typename Owner>
std::string print_entries(const std::vector<Owner>& entries, std::span<const Key<Owner>> keys,
                          Comments comments, std::size_t indent) {
  std::ostringstream out;
  Comments here = comments;  // the first entry explains the keys
  for (const Owner& entry : entries) {
    OwnerPrinter<Owner>(out, here, indent).print(entry, keys, true, [](std::string_view) {});
    here = Comments::kNone;
  }
  return out.str();
}

// Made comments, so that an example may stand where the default is none.
std::string commented_out(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) result += "  # " + line.substr(2) + "\n";
  return result;
}

std::string print_interfaces(const Config& config, Comments comments) {
  std::string text;
  if (comments == Comments::kAll) {
    text += "  # The radios and cables of the mesh: 0 to " + std::to_string(kMaxInterfaces) +
            ". While none is named, this node keeps to itself.\n";
  }
  const auto& interfaces = config.mesh.interfaces;
  if (!interfaces.empty()) {
    return text + "  interfaces:\n" + print_entries(interfaces, interface_keys(), comments, 6);
  }
  text += "  interfaces: []\n";
  if (comments == Comments::kAll) {
    const std::vector<MeshInterfaceConfig> example(1);
    text += "  # Or, for example:\n  # interfaces:\n" +
            commented_out(print_entries(example, interface_keys(), comments, 6));
  }
  return text;
}

std::string print_sensors(const Config& config, Comments comments) {
  std::string text;
  if (comments == Comments::kAll) {
    text += "\n# The lidars: 1 to " + std::to_string(kMaxSensors) +
            ", of a base none. Scans name theirs; others are refused.\n";
  }
  text += std::string(kSensorsKey) + ":";
  if (config.sensors.empty()) return text + " []\n";
  return text + "\n" + print_entries(config.sensors, sensor_keys(), comments, 4);
}

std::string print(const Config& config, Comments comments) {
  std::ostringstream out;
  OwnerPrinter<Config>(out, comments, 0)
      .print(config, root_keys(), false, [&](std::string_view key) {
        if (key == kInterfacesAfter) out << print_interfaces(config, comments);
      });
  out << print_sensors(config, comments);
  return out.str();
}

}  // namespace

std::string print_config(const Config& config) {
  const SensorModel model = config.map.sensor_model.resolved();
  std::string text = print(config, Comments::kNone);
  text += "# The sensor model resolved: hit " + print_number(model.hit) + ", miss " +
          print_number(model.miss) + ", minimum " + print_number(model.minimum) + ", maximum " +
          print_number(model.maximum) + "\n";
  return text;
}

std::string print_sample(const Config& config) {
  return "# SPDX-License-Identifier: Apache-2.0\n"
         "# Configuration of warrend. What is left out has its default; what is unknown is an "
         "error.\n"
         "# Check it with: warrend --check FILE\n" +
         print(config, Comments::kAll);
}

ConfigChanges compare_configs(const Config& before, const Config& after) {
  Config a = before;
  Config b = after;
  ConfigChanges changes;
  for (const RootKey& key : root_keys()) {
    if (print_value(key.slot(a), rule_of(key)) == print_value(key.slot(b), rule_of(key))) continue;
    auto& list = key.takes == Takes::kReload ? changes.effective : changes.needs_restart;
    list.emplace_back(key.name);
  }
  if (!(before.mesh.interfaces == after.mesh.interfaces)) {
    changes.needs_restart.emplace_back(kInterfacesKey);
  }
  if (!(before.sensors == after.sensors)) changes.effective.emplace_back(kSensorsKey);
  return changes;
}

Config reloaded(const Config& running, const Config& wanted) {
  Config result = running;
  Config source = wanted;
  for (const RootKey& key : root_keys()) {
    if (key.takes != Takes::kReload) continue;
    const auto copy = [&](auto to) {
      const auto from = std::get<decltype(to)>(key.slot(source));
      if constexpr (std::is_same_v<decltype(to), ChoiceSlot>) {
        *to.value = *from.value;
      } else {
        *to = *from;
      }
    };
    std::visit(copy, key.slot(result));
  }
  result.sensors = wanted.sensors;
  return result;
}

}  // namespace warren
