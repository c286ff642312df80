// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/value.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "transport/udp/address_text.hpp"

namespace warren {
namespace {

using Result = tl::expected<void, std::string>;
using Failure = tl::unexpected<std::string>;

constexpr std::string_view kNameCharacters = "abcdefghijklmnopqrstuvwxyz0123456789_-";
constexpr std::string_view kPlainCharacters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./";
constexpr std::uint32_t kAllPermissions = 0777;

std::string in_quotes(std::string_view text) {
  std::string result(1, '\'');
  for (const char c : text) result.append(c == '\'' ? 2 : 1, c);
  result.push_back('\'');
  return result;
}

// Words that YAML would read as something else than text.
bool needs_quotes(std::string_view text) {
  constexpr std::array<std::string_view, 5> kNulls{"null", "Null", "NULL", "~", ""};
  return std::find(kNulls.begin(), kNulls.end(), text) != kNulls.end() || text.front() == '-' ||
         text.find_first_not_of(kPlainCharacters) != std::string_view::npos;
}

std::optional<double> number_of(const RawScalar& scalar) {
  double number = 0.0;
  const char* end = scalar.text.data() + scalar.text.size();
  const auto [stop, error] = std::from_chars(scalar.text.data(), end, number);
  if (scalar.quoted || scalar.is_null || error != std::errc{} || stop != end) return std::nullopt;
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

tl::expected<double, std::string> number_within(const RawScalar& scalar, const Limits& limits) {
  const auto number = number_of(scalar);
  if (!number) return Failure("is not a number");
  if (*number < limits.lowest || *number > limits.highest) return Failure("is out of range");
  return *number;
}

std::string range_text(const Limits& limits) {
  return print_number(limits.lowest) + " to " + print_number(limits.highest);
}

struct Reader {
  const RawValue& raw;
  const ValueRule& rule;

  const RawScalar& scalar() const { return raw.scalars.front(); }
  bool is_null() const { return !raw.is_list && scalar().is_null; }
  Result no_text() const {
    if (raw.is_list) return Failure("is a list");
    if (scalar().is_null) return Failure("is no value");
    return {};
  }

  Result operator()(double* value) const {
    if (raw.is_list) return Failure("is a list");
    return number_within(scalar(), rule.limits).map([&](double number) { *value = number; });
  }
  Result operator()(std::optional<double>* value) const {
    if (is_null()) return value->reset(), Result{};
    if (raw.is_list) return Failure("is a list");
    return number_within(scalar(), rule.limits).map([&](double number) { *value = number; });
  }
  Result operator()(std::uint32_t* value) const {
    if (raw.is_list) return Failure("is a list");
    const auto number = number_within(scalar(), rule.limits);
    if (!number) return Failure(number.error());
    if (*number != std::floor(*number)) return Failure("is not a whole number");
    *value = static_cast<std::uint32_t>(*number);
    return {};
  }
  Result operator()(bool* value) const {
    const bool is_true = !raw.is_list && scalar().text == "true";
    const bool is_false = !raw.is_list && scalar().text == "false";
    if (scalar_is_quoted() || (!is_true && !is_false)) return Failure("is not true or false");
    *value = is_true;
    return {};
  }
  Result operator()(std::string* value) const {
    if (auto text = no_text(); !text) return text;
    const std::string& name = scalar().text;
    if (name.empty() || name.size() > kMaxNameBytes || name.front() == '-' ||
        name.find_first_not_of(kNameCharacters) != std::string::npos) {
      return Failure("is not a name");
    }
    *value = name;
    return {};
  }
  Result operator()(std::filesystem::path* value) const {
    if (auto text = no_text(); !text) return text;
    const std::string& path = scalar().text;
    const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
    if (path.empty() || path.front() != '/') return Failure("is not an absolute path");
    if (path.size() > kMaxSocketPathBytes) return Failure("is too long");
    if (std::any_of(path.begin(), path.end(), is_control)) return Failure("is not printable");
    *value = path;
    return {};
  }
  Result operator()(FileMode* value) const {
    if (auto text = no_text(); !text) return text;
    std::uint32_t bits = 0;
    const char* end = scalar().text.data() + scalar().text.size();
    const auto [stop, error] = std::from_chars(scalar().text.data(), end, bits, 8);
    const bool is_octal = error == std::errc{} && stop == end && scalar().text.size() == 4;
    if (!is_octal || bits > kAllPermissions) return Failure("is not a file mode");
    value->bits = bits;
    return {};
  }
  Result operator()(std::optional<Eigen::Vector3d>* value) const {
    if (is_null()) return value->reset(), Result{};
    if (!raw.is_list || raw.scalars.size() != 3) return Failure("is not a list of three numbers");
    Eigen::Vector3d vector;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto number = number_within(raw.scalars[i], rule.limits);
      if (!number) return Failure(number.error());
      vector[static_cast<Eigen::Index>(i)] = *number;
    }
    *value = vector;
    return {};
  }
  Result operator()(std::vector<MeshAddress>* value) const {
    if (!raw.is_list) return Failure("is not a list");
    if (raw.scalars.size() > kMaxSeeds) return Failure("is too long");
    std::vector<MeshAddress> addresses;
    for (const RawScalar& text : raw.scalars) {
      const auto address = mesh::parse_mesh_address(text.text);
      if (!address) return Failure("has something that is no address and port");
      addresses.push_back(*address);
    }
    *value = std::move(addresses);
    return {};
  }
  Result operator()(const ChoiceSlot& choice) const {
    if (auto text = no_text(); !text) return text;
    const auto found = std::find(rule.choices.begin(), rule.choices.end(), scalar().text);
    if (found == rule.choices.end()) return Failure("is none of these");
    *choice.value = static_cast<unsigned char>(found - rule.choices.begin());
    return {};
  }

  bool scalar_is_quoted() const { return !raw.is_list && scalar().quoted; }
};

struct Printer {
  const ValueRule& rule;

  std::string operator()(const double* value) const { return print_number(*value); }
  std::string operator()(const std::optional<double>* value) const {
    return *value ? print_number(**value) : "null";
  }
  std::string operator()(const std::uint32_t* value) const { return std::to_string(*value); }
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const std::string* value) const {
    return needs_quotes(*value) ? in_quotes(*value) : *value;
  }
  std::string operator()(const std::filesystem::path* value) const {
    return needs_quotes(value->native()) ? in_quotes(value->native()) : value->native();
  }
  std::string operator()(const FileMode* value) const {
    std::string octal = "0000";
    for (std::size_t i = 0; i < 4; ++i) octal[3 - i] += static_cast<char>(value->bits >> 3 * i & 7);
    return in_quotes(octal);  // or other readers of YAML take it for a decimal number
  }
  std::string operator()(const std::optional<Eigen::Vector3d>* value) const {
    if (!*value) return "null";
    const Eigen::Vector3d& v = **value;
    std::string list(1, '[');
    list.append(print_number(v.x())).append(", ").append(print_number(v.y()));
    return list.append(", ").append(print_number(v.z())).append("]");
  }
  std::string operator()(const std::vector<MeshAddress>* value) const {
    std::string list;
    for (const MeshAddress& address : *value) {
      list += (list.empty() ? "" : ", ") + in_quotes(mesh::to_text(address));
    }
    return list.insert(0, 1, '[').append(1, ']');
  }
  std::string operator()(const ChoiceSlot& choice) const {
    return std::string(rule.choices[*choice.value]);
  }
};

struct Describer {
  const ValueRule& rule;

  std::string operator()(const double*) const { return range_text(rule.limits); }
  std::string operator()(const std::optional<double>*) const {
    return range_text(rule.limits) + ", or null";
  }
  std::string operator()(const std::uint32_t*) const {
    return range_text(rule.limits) + ", whole numbers";
  }
  std::string operator()(const bool*) const { return "true, false"; }
  std::string operator()(const std::string*) const {
    return "1 to " + std::to_string(kMaxNameBytes) + " of a-z 0-9 _ -, not beginning with -";
  }
  std::string operator()(const std::filesystem::path*) const {
    return "an absolute path of at most " + std::to_string(kMaxSocketPathBytes) + " bytes";
  }
  std::string operator()(const FileMode*) const { return "0000 to 0777, four octal digits"; }
  std::string operator()(const std::optional<Eigen::Vector3d>*) const {
    return "[x, y, z], each " + range_text(rule.limits) + ", or null";
  }
  std::string operator()(const std::vector<MeshAddress>*) const {
    return "a list of at most " + std::to_string(kMaxSeeds) +
           " addresses with ports, e.g. ['10.9.0.2:7717', '[fe80::1]:7717']";
  }
  std::string operator()(const ChoiceSlot&) const {
    std::string all;
    for (const auto choice : rule.choices) {
      if (!all.empty()) all.append(", ");
      all.append(choice);
    }
    return all;
  }
};

}  // namespace

Result read_value(const RawValue& raw, const Slot& slot, const ValueRule& rule) {
  if (!raw.is_list && raw.scalars.size() != 1) return Failure("is not a value");
  return std::visit(Reader{raw, rule}, slot);
}

std::string print_value(const Slot& slot, const ValueRule& rule) {
  return std::visit(Printer{rule}, slot);
}

std::string describe_allowed(const Slot& slot, const ValueRule& rule) {
  return std::visit(Describer{rule}, slot);
}

std::string print_number(double number) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  return {buffer.data(), result.ptr};
}

}  // namespace warren
