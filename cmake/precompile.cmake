# SPDX-License-Identifier: Apache-2.0
# Most of a compile is parsing headers that never change: they are parsed once per set of flags.
# clang-tidy does without, so each file still has to include what it uses.
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/precompiled.cpp CONTENT "")

# warren_precompile(NAME headers...): of this target others reuse the precompiled headers.
function(warren_precompile name)
  target_link_libraries(${name} PRIVATE warren_options Eigen3::Eigen tl::expected)
  target_precompile_headers(${name} PRIVATE
    <algorithm> <array> <bit> <cassert> <chrono> <cmath> <compare> <cstddef> <cstdint> <cstring> <deque>
    <filesystem> <functional> <limits> <map> <memory> <numbers> <optional> <set> <span> <string>
    <string_view> <tuple> <unordered_map> <utility> <variant> <vector>
    <tl/expected.hpp> <Eigen/Geometry> ${ARGN})
endfunction()

add_library(warren_headers OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
warren_precompile(warren_headers)
