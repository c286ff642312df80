// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace warren {

// The text with blanks for whatever a terminal takes for a command: it may be anybody's. That is
// line breaks and all other controls, those of Latin-1 in UTF-8 included.
std::string printable(std::string_view text);

}  // namespace warren
