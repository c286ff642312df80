// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/encoded_fields.hpp"
#include "daemon/control/response.hpp"
#include "proto/framing.hpp"
#include "warren/control.pb.h"

namespace warren {
std::string encode_blocks(const BlocksAnswer& answer) {
  control::Response response;
  auto& blocks = *response.mutable_blocks();
  blocks.set_resolution_m(answer.resolution_m);
  add_vector(answer.origin_map, *blocks.mutable_origin_map_m());
  add_vector(answer.T_fleet_map.translation, *blocks.mutable_t_fleet_map());
  for (const double q : answer.T_fleet_map.rotation.coeffs()) blocks.add_t_fleet_map(q);
  if (answer.position_map) add_vector(*answer.position_map, *blocks.mutable_position_map_m());
  blocks.set_anew(answer.anew);
  blocks.set_more(answer.is_part());
  blocks.set_cursor(encode_cursor(answer.cursor));
  for (const BlockKey& key : answer.keys) {
    for (const std::int32_t axis : {key.x, key.y, key.z}) blocks.add_keys(axis);
  }
  blocks.set_codes(answer.codes);
  return framed(response.SerializeAsString());
}

std::string encode_rays(const RaysAnswer& answer) {
  control::Response response;
  for (const RayEnd& end : answer.ends) {
    auto& told = *response.mutable_rays()->add_ends();
    told.set_state(name_of(end.code.state()));
    told.set_range_m(end.range_m);
    if (end.voxel) add_vector(answer.low_map(*end.voxel), *told.mutable_low_map_m());
    if (const auto cost = decode_cost(end.code.cost())) told.set_cost(*cost);
    told.set_stair(end.code.stair());
  }
  return framed(response.SerializeAsString());
}

}  // namespace warren
