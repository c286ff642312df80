// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace warren::mesh {

// For std::visit: one function for each alternative.
template <typename... Visits>
struct Visitor : Visits... {
  using Visits::operator()...;
};
template <typename... Visits>
Visitor(Visits...) -> Visitor<Visits...>;

}  // namespace warren::mesh
