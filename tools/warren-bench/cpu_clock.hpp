// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace warren {

// User CPU time of the calling thread, seconds.
double user_cpu_s();
// User and system CPU time of it, to the nanosecond: user time alone is split by the tick.
double thread_cpu_s();

}  // namespace warren
