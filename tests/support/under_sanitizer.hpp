// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace warren::test {

// Sanitizers find faults of memory in a few repetitions, and make each ten times as slow: what
// proves values by many repetitions does fewer there. GCC defines the first two, clang has the
// features.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kUnderSanitizer = true;
#elif defined(__clang__)
inline constexpr bool kUnderSanitizer =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kUnderSanitizer = false;
#endif

}  // namespace warren::test
