#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_threads.sh THREADED PROGRAM..: fails if a PROGRAM, which TSan's build leaves out, can start a
# thread. THREADED does start some: it must be seen, or this check is blind.
set -euo pipefail

starts_threads() {
  [ -x "$1" ] || { echo "no program $1"; exit 1; }
  nm --dynamic --undefined-only "$1" | grep -E '_ZNSt6thread|pthread_create|thrd_create' >/dev/null
}

starts_threads "$1" || { echo "$1 is not seen to start threads"; exit 1; }
status=0
for program in "${@:2}"; do
  if starts_threads "$program"; then
    echo "$program starts threads: let its warren_test() say THREADED, so that TSan runs it"
    status=1
  fi
done
exit $status
