// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/source_legend.hpp"

#include <array>
#include <cstdio>

namespace warren {
namespace {

constexpr std::array<Colour, kSourceColours> kColours = {{{240, 240, 240},
                                                          {230, 159, 0},
                                                          {86, 180, 233},
                                                          {0, 158, 115},
                                                          {204, 121, 167},
                                                          {0, 114, 178},
                                                          {213, 94, 0},
                                                          {240, 228, 66}}};
constexpr Colour kFurther{128, 128, 128};

}  // namespace

Colour colour_of_source(SourceNumber source) {
  return source < kColours.size() ? kColours[source] : kFurther;
}

std::string short_name_of(const LayerId& layer, const std::string& node) {
  const std::string name = node.empty() ? "robot " + std::to_string(layer.origin) : node;
  return name + " layer " + std::to_string(layer.number);
}

std::string line_of_source(SourceNumber source, const std::vector<LayerId>& others,
                           const std::vector<std::string>& names) {
  if (source == 0) return "source 0: this robot";
  const LayerId& layer = others[source - std::size_t{1}];
  const std::string& name = names[source - std::size_t{1}];
  std::array<char, 17> incarnation{};
  std::snprintf(incarnation.data(), incarnation.size(), "%016llx",
                static_cast<unsigned long long>(layer.incarnation));
  return "source " + std::to_string(source) + ": " + short_name_of(layer, "") + " incarnation " +
         incarnation.data() + (name.empty() ? "" : " " + name);
}

}  // namespace warren
