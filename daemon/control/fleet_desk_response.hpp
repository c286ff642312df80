// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/layer/claim.hpp"
#include "core/registration/layer_registration.hpp"
#include "daemon/fleet/fleet_path.hpp"
#include "daemon/fleet/message_desk.hpp"

namespace warren {

// What a client is told of the inbox; names of senders, in the order of the messages.
struct InboxReport {
  InboxExcerpt excerpt;
  std::vector<std::string> senders;
  std::uint64_t dropped = 0;
};

// Responses as they go over the wire, length included.
std::string encode_message_accepted(std::uint32_t number);
std::string encode_messages(const InboxReport& report);
std::string encode_fleet_ordered(const std::vector<LayerId>& layers);
std::string encode_trajectory(const std::string& node, const FleetPath& path);
std::string encode_align_estimate(const LayerId& layer, const LayerId& against,
                                  const RegistrationResult& result);

}  // namespace warren
