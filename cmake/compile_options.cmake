# SPDX-License-Identifier: Apache-2.0
# One interface target carries every flag: link warren_options, set nothing globally.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

# No NDEBUG anywhere: asserts guard against the programmer's errors in all builds.
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -g1")
set(CMAKE_CXX_FLAGS_SANITIZE "-O1 -g1 -fno-omit-frame-pointer")
set(CMAKE_C_FLAGS_SANITIZE "-O1 -g1")

add_library(warren_options INTERFACE)
target_include_directories(warren_options INTERFACE ${CMAKE_SOURCE_DIR})
# Floats must round alike on every CPU: no fused multiply-add behind our back.
target_compile_options(warren_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -ffp-contract=off
  $<$<BOOL:${WARREN_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  target_compile_definitions(warren_options INTERFACE ASIO_HAS_CO_AWAIT=1 ASIO_HAS_STD_COROUTINE=1)
  target_compile_options(warren_options INTERFACE -Wno-sign-conversion)
endif()
if(WARREN_SANITIZE)
  target_compile_options(warren_options INTERFACE -fsanitize=${WARREN_SANITIZE} -fno-sanitize-recover=all)
  target_link_options(warren_options INTERFACE -fsanitize=${WARREN_SANITIZE})
  # Under ASan Eigen would align by itself what it allocates, and PCL's libraries free it as if malloc had.
  target_compile_definitions(warren_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_compile_options(warren_options INTERFACE -fno-sanitize=function)
  elseif(WARREN_SANITIZE MATCHES "thread")
    target_compile_options(warren_options INTERFACE -Wno-tsan)
  endif()
endif()
if(WARREN_FUZZ)
  target_compile_options(warren_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(WARREN_COVERAGE)
  target_compile_options(warren_options INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(warren_options INTERFACE --coverage)
endif()

# warren_library(NAME sources...): a static library of ours with our flags.
function(warren_library name)
  add_library(${name} STATIC ${ARGN})
  target_link_libraries(${name} PUBLIC warren_options)
  target_precompile_headers(${name} REUSE_FROM warren_headers)
  if(WARREN_SANITIZE MATCHES "thread")
    # Only what its fewer programs link.
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
endfunction()
