# SPDX-License-Identifier: Apache-2.0
"""Whole fleets on one machine: real daemons behind emulated radios, driven by simulated robots, and
watched from outside. For tests/soak, tools/demo and tools/bench; needs Debian's python3-protobuf."""
