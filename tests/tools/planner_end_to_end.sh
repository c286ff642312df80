#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The real programs, as planners use them. Usage: planner_end_to_end.sh BIN_DIR SOURCE_DIR CASE
# shellcheck source=tests/tools/end_to_end_parts.sh
. "$(dirname "$0")/end_to_end_parts.sh"

plan() { # ARG..
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$work timeout 120 "$python" "$source/tools/python/plan.py" "$work/control.sock" "$@"
}

case_a_planner_in_python_finds_a_way_over_the_map() {
  "$python" -c 'import google.protobuf' 2>/dev/null || { echo "SKIPPED: no python3-protobuf"; exit 0; }
  local goal=(4 -4 0)
  protoc -I "$source/proto/warren" --python_out="$work" control.proto
  start_daemon
  if plan "${goal[@]}" 2>"$work/err"; then fail "planned without a map"; fi
  grep -q "no map yet" "$work/err" || fail "$(cat "$work/err")"
  # It waits for a map, and plans whenever that has changed.
  plan "${goal[@]}" --seconds 25 --rate 5 >"$work/plans" &
  local planner=$!
  columns=512 simulate run 60 --socket "$work/ingest.sock" >/dev/null 2>&1 || fail "no run"
  wait "$planner" || fail "the planner ended with $?: $(tail -n 3 "$work/plans")"
  [ "$(grep -cE '^(way|no)' "$work/plans")" -gt 1 ] || fail "planned but once: $(cat "$work/plans")"
  plan "${goal[@]}" --check --picture "$work/way.png" >"$work/plan"
  grep -qE '^way of [0-9.]+ m' "$work/plan" || fail "$(cat "$work/plan")"
  [ "$(stat -c %s "$work/way.png")" -gt 1000 ] || fail "no picture"
  # The daemon's word on a square in the footprint is the oracle.
  local valid places
  read -r valid places < <(sed -nE 's/^the daemon finds ([0-9]+) of ([0-9]+) places valid/\1 \2/p' "$work/plan")
  [ $((valid * 10)) -ge $((places * 9)) ] || fail "$valid of $places places are valid: $(cat "$work/plan")"
  if plan 500 0 0 >"$work/plan"; then fail "planned a way out of the world"; fi
  grep -q "no ground" "$work/plan" || fail "$(cat "$work/plan")"
  stop_daemon
}

case_rays_are_asked_about() {
  local ctl=("$bin/warrenctl" --socket "$work/control.sock")
  scene 10
  start_daemon
  replay --rate max >/dev/null || fail "replay: $(cat "$work/replay.err")"
  wait_until "two ticks" ticked "$(($(published_field ticks) + 2))"
  "${ctl[@]}" layer flush >/dev/null
  for source in "" --merge; do
    "${ctl[@]}" query ray 2 0 0.5  0 0 -1 $source --through-unknown >"$work/down"
    grep -qE '^occupied at [0-9.]+ m, the voxel from .*, cost ' "$work/down" || fail "$(cat "$work/down")"
  done
  "${ctl[@]}" query ray 2 0 0.5  0 0 -1 --max-range 0.1 | grep -qE 'nothing within 0.10|unknown at' || fail "saw the floor"
  "${ctl[@]}" query ray 900 0 0  0 0 1 --json >"$work/far.json"
  "$python" -c 'import json,sys; e=json.load(open(sys.argv[1]))["ends"]; sys.exit(e[0]["state"] != "unknown")' \
    "$work/far.json" || fail "$(cat "$work/far.json")"
  if "${ctl[@]}" query ray 0 0 0  0 0 0 2>"$work/err"; then fail "took no direction"; fi
  grep -q "not zero" "$work/err" || fail "$(cat "$work/err")"
  stop_daemon
}

"case_$case"
