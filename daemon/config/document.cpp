// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/document.hpp"

#include <optional>
#include <set>
#include <string_view>

#include <yaml-cpp/yaml.h>

#include "daemon/config/value.hpp"

namespace warren {
namespace {

constexpr std::size_t kShownValueBytes = 60;

int line_of(const YAML::Node& node) { return node.Mark().line + 1; }

RawScalar raw_scalar(const YAML::Node& node) {
  // yaml-cpp tags quoted scalars "!", plain ones "?".
  if (node.IsNull()) return {"null", false, true};
  return {node.Scalar(), node.Tag() == "!", false};
}

// Nothing when the node is neither a scalar nor a list of scalars.
std::optional<RawValue> raw_value(const YAML::Node& node) {
  if (node.IsScalar() || node.IsNull()) return RawValue{false, {raw_scalar(node)}};
  if (!node.IsSequence()) return std::nullopt;
  RawValue value{true, {}};
  for (const auto& item : node) {
    if (!item.IsScalar()) return std::nullopt;
    value.scalars.push_back(raw_scalar(item));
  }
  return value;
}

std::string shown(const RawValue& raw) {
  std::string text;
  for (const RawScalar& scalar : raw.scalars) {
    text += (text.empty() ? "" : ", ") + scalar.text;
    if (text.size() > kShownValueBytes) {
      text.resize(kShownValueBytes);
      text += "...";
      break;
    }
  }
  if (!raw.is_list) return text;
  return text.insert(0, 1, '[').append(1, ']');
}

// Walks one owner's part of the document: Config, or one of its sensors.
template <typename Owner>
class OwnerReader {
 public:
  OwnerReader(Owner& owner, std::span<const Key<Owner>> keys, std::string place, FaultList& faults)
      : owner_(owner), keys_(keys), place_(std::move(place)), faults_(faults) {}

  // `other` is called for a key that is no part of this schema; it says whether it knew it.
  template <typename Other>
  void read_section(const YAML::Node& node, const std::string& section, const Other& other) {
    std::set<std::string> seen;
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) {
        faults_.add_at(line_of(entry.first), "a key must be plain text");
        continue;
      }
      const std::string key = section + entry.first.Scalar();
      faults_.set_line(place_ + key, line_of(entry.first));
      if (!seen.insert(key).second) {
        faults_.add(place_ + key, "stands here twice");
      } else {
        read_entry(key, entry.second, other);
      }
    }
  }

 private:
  template <typename Other>
  void read_entry(const std::string& key, const YAML::Node& node, const Other& other) {
    for (const Key<Owner>& known : keys_) {
      if (known.name == key) return read_key(known, node);
    }
    if (is_section(key)) {
      if (node.IsMap()) return read_section(node, key + ".", other);
      if (!node.IsNull()) faults_.add(place_ + key, "must be a section of keys");
      return;
    }
    if (!other(key, node)) faults_.add(place_ + key, "unknown key");
  }

  bool is_section(const std::string& key) const {
    const auto is_within = [&](const Key<Owner>& known) {
      return known.name.size() > key.size() && known.name.substr(0, key.size()) == key &&
             known.name[key.size()] == '.';
    };
    return std::any_of(keys_.begin(), keys_.end(), is_within);
  }

  void read_key(const Key<Owner>& key, const YAML::Node& node) {
    const ValueRule rule{key.limits, key.choices};
    const Slot slot = key.slot(owner_);
    const std::string name = place_ + std::string(key.name);
    const auto raw = raw_value(node);
    if (!raw) return faults_.add(name, "must be a value; allowed: " + describe_allowed(slot, rule));
    const auto result = read_value(*raw, slot, rule);
    if (result) return;
    std::string what(1, '\'');
    what.append(shown(*raw)).append("' ").append(result.error());
    faults_.add(name, what.append("; allowed: ").append(describe_allowed(slot, rule)));
  }

  Owner& owner_;
  std::span<const Key<Owner>> keys_;
  std::string place_;
  FaultList& faults_;
};

// What the reader of lists needs to know of one.
template <typename Owner>
struct ListRule {
  std::string_view key;
  std::span<const Key<Owner>> keys;
  std::size_t most = 0;
  std::string_view entries;  // what they are called, and one of them
  std::string_view entry;
};

template <typename Owner>
void read_entry_of(const ListRule<Owner>& rule, const YAML::Node& node, const std::string& place,
                   Owner& owner, FaultList& faults) {
  if (!node.IsMap()) return faults.add_at(line_of(node), place + ": must be a section of keys");
  faults.set_line(place + ".name", line_of(node));
  if (!node["name"]) {
    faults.add(place + ".name", "missing: every " + std::string(rule.entry) + " needs one");
  }
  const auto no_other = [](const std::string&, const YAML::Node&) { return false; };
  OwnerReader<Owner>(owner, rule.keys, place + ".", faults).read_section(node, "", no_other);
}

// Nothing if it is no such list; faults within its entries are told, but it is one.
template <typename Owner>
std::optional<std::vector<Owner>> read_list(const ListRule<Owner>& rule, const YAML::Node& node,
                                            FaultList& faults) {
  const std::string key(rule.key);
  if (!node.IsSequence() || node.size() > rule.most) {
    faults.add(key, "must be a list of at most " + std::to_string(rule.most) + " " +
                        std::string(rule.entries));
    return std::nullopt;
  }
  std::vector<Owner> owners;
  for (const auto& item : node) {
    const std::string place = key + "[" + std::to_string(owners.size()) + "]";
    read_entry_of(rule, item, place, owners.emplace_back(), faults);
  }
  return owners;
}

}  // namespace

Config read_document(const YAML::Node& root, FaultList& faults) {
  Config config;
  if (root.IsNull()) return config;
  if (!root.IsMap()) {
    faults.add_at(line_of(root), "must be sections of keys");
    return config;
  }
  const ListRule<SensorConfig> sensors{kSensorsKey, sensor_keys(), kMaxSensors, "sensors",
                                       "sensor"};
  const ListRule<MeshInterfaceConfig> interfaces{kInterfacesKey, interface_keys(), kMaxInterfaces,
                                                 "interfaces", "interface"};
  bool sensors_given = false;
  const auto read_lists = [&](const std::string& key, const YAML::Node& node) {
    if (key == kSensorsKey) {
      sensors_given = true;
      if (auto list = read_list(sensors, node, faults)) config.sensors = *std::move(list);
    } else if (key == kInterfacesKey) {
      if (auto list = read_list(interfaces, node, faults)) {
        config.mesh.interfaces = *std::move(list);
      }
    } else {
      return false;
    }
    return true;
  };
  OwnerReader<Config>(config, root_keys(), "", faults).read_section(root, "", read_lists);
  if (config.node.role == Role::kBase && !sensors_given) config.sensors.clear();
  check_consistency(config, faults);
  return config;
}

}  // namespace warren
