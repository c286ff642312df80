// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/earlier_layer.hpp"

#include "core/exchange/file_ending.hpp"
#include "core/exchange/layer_file.hpp"
#include "core/exchange/octomap_reader.hpp"

namespace warren {

tl::expected<Replica, std::string> read_earlier_layer(const std::filesystem::path& file) {
  constexpr std::uint32_t kNobody = 0;
  const std::string ending = lower_case_ending(file);
  if (ending == ".layer") return read_layer(file);
  if (ending == ".bt" || ending == ".ot") return read_octomap(file, kNobody);
  return tl::unexpected("cannot load " + file.string() + ": the ending must be .layer, .bt or .ot");
}

}  // namespace warren
