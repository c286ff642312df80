// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/config/config.hpp"

namespace warren {

// An enumeration's value; Key::choices names its values from 0 up.
struct ChoiceSlot {
  unsigned char* value;
};

// Where a key's value lives; its type says how it is read, checked and printed. An optional may be
// `null` in YAML.
using Slot = std::variant<double*, std::optional<double>*, std::uint32_t*, bool*, std::string*,
                          std::filesystem::path*, FileMode*, std::optional<Eigen::Vector3d>*,
                          std::vector<MeshAddress>*, ChoiceSlot>;

struct Limits {
  double lowest = 0.0;
  double highest = 0.0;
};

enum class Takes : std::uint8_t { kReload, kRestart };

// One line of the schema: parser, printer, reload and the sample in config/ all follow it.
template <typename Owner>
struct Key {
  std::string_view name;  // dotted, from the owner down; the unit is its suffix
  std::string_view doc;   // one sentence
  Takes takes;            // what makes a change effective
  Slot (*slot)(Owner&);
  Limits limits{};  // of numbers, both allowed
  std::span<const std::string_view> choices{};
};

using RootKey = Key<Config>;
using SensorKey = Key<SensorConfig>;
using InterfaceKey = Key<MeshInterfaceConfig>;

// Every key but the two lists, in the order of printing.
std::span<const RootKey> root_keys();
// Every key of one entry of the list `sensors`; the same of `mesh.interfaces`.
std::span<const SensorKey> sensor_keys();
std::span<const InterfaceKey> interface_keys();

inline constexpr std::string_view kSensorsKey = "sensors";
inline constexpr std::size_t kMaxSensors = 16;
inline constexpr std::string_view kInterfacesKey = "mesh.interfaces";
// The list is printed behind this key.
inline constexpr std::string_view kInterfacesAfter = "mesh.shutdown_s";
inline constexpr std::size_t kMaxInterfaces = 8;
inline constexpr std::size_t kMaxSeeds = 64;
inline constexpr std::size_t kMaxNameBytes = 32;
// What fits sockaddr_un with its terminating zero.
inline constexpr std::size_t kMaxSocketPathBytes = 107;

}  // namespace warren
