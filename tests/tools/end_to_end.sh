#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The real programs over real sockets. Usage: end_to_end.sh BIN_DIR SOURCE_DIR CASE
# shellcheck source=tests/tools/end_to_end_parts.sh
. "$(dirname "$0")/end_to_end_parts.sh"

case_replays_a_recording_without_a_drop() {
  scene 30
  start_daemon
  replay --rate max >"$work/summary.json" || fail "replay: $(cat "$work/replay.err")"
  [ "$(field taken <"$work/summary.json")" = 30 ] || fail "$(cat "$work/summary.json")"
  status
  [ "$(mapped scans)" = 30 ] || fail "$(cat "$work/status.json")"
  [ "$(mapped voxels_occupied)" -gt 1000 ] || fail "$(cat "$work/status.json")"
  for ending in bt ot ply pcd png; do
    "$bin/warrenctl" --socket "$work/control.sock" map save "$work/map.$ending" >/dev/null
    [ -s "$work/map.$ending" ] || fail "no map.$ending"
  done
  if "$bin/warrenctl" --socket "$work/control.sock" map save "$work/map.doc" 2>"$work/err"; then
    fail "saved a .doc"
  fi
  grep -q '\.bt' "$work/err" || fail "the error does not name the endings: $(cat "$work/err")"
  stop_daemon
  [ ! -e "$work/ingest.sock" ] || fail "left its socket behind"
}

case_survives_a_replayer_that_is_killed() {
  scene 40
  start_daemon
  replay --rate 20 >/dev/null &
  local victim=$!
  for _ in $(seq 300); do
    status
    [ "$(mapped scans)" -ge 3 ] && break
    sleep 0.05
  done
  kill -KILL "$victim"
  wait "$victim" 2>/dev/null || true
  pkill -KILL -f "$work/ingest.sock.*--rate 20" 2>/dev/null || true
  replay --rate max --frame-epoch 2 >"$work/summary.json" || fail "$(cat "$work/replay.err")"
  [ "$(field taken <"$work/summary.json")" = 40 ] || fail "$(cat "$work/summary.json")"
  stop_daemon
}

case_drops_the_oldest_when_flooded_and_says_so() {
  # A scan takes many milliseconds to integrate, and one comes every millisecond.
  "$bin/warren-sim" record --world cave --length 60 --seconds 1.65 --out "$work/scene" \
    --drivability-spacing 0 2>/dev/null
  start_daemon 1
  replay --rate 1000 >"$work/summary.json" || true
  local answered=0
  for outcome in taken dropped_overload dropped_out_of_order rejected; do
    answered=$((answered + $(field "$outcome" <"$work/summary.json")))
  done
  [ "$answered" = 16 ] || fail "not every scan was answered: $(cat "$work/summary.json")"
  [ "$(field dropped_overload <"$work/summary.json")" -gt 0 ] || fail "$(cat "$work/summary.json")"
  stop_daemon
}

case_says_what_is_wrong_when_no_daemon_runs() {
  scene 1
  if replay >/dev/null; then fail "replayed to nobody"; fi
  grep -q "is warrend running" "$work/replay.err" || fail "$(cat "$work/replay.err")"
  if "$bin/warrenctl" --socket "$work/control.sock" status 2>"$work/err"; then fail "status of nobody"; fi
  grep -q "is warrend running" "$work/err" || fail "$(cat "$work/err")"
}

case_the_python_client_is_taken() {
  "$python" -c 'import google.protobuf' 2>/dev/null || { echo "SKIPPED: no python3-protobuf"; exit 0; }
  start_daemon
  protoc -I "$source/proto/warren" --python_out="$work" ingest.proto
  PYTHONPATH=$work "$python" "$source/tools/python/warren_ingest.py" "$work/ingest.sock" lidar ||
    fail "the Python client failed"
  stop_daemon
}

case_a_recording_has_the_same_bytes_every_time() {
  local team=(--world cave --length 60 --robots 2 --people 1 --stagger 1 --columns 64 --seconds 2)
  for run in first second; do
    "$bin/warren-sim" record "${team[@]}" --seed 3 --out "$work/$run" 2>/dev/null
  done
  [ "$(ls "$work/first/robot-1/clouds" | wc -l)" = 10 ] || fail "robot-1 has not 10 sweeps"
  [ -s "$work/first/truth/mesh.ply" ] || fail "no truth"
  diff -r "$work/first" "$work/second" || fail "two runs differ"
  "$bin/warren-sim" record "${team[@]}" --seed 4 --out "$work/other" 2>/dev/null
  if diff -rq "$work/first" "$work/other" >/dev/null; then fail "two seeds agree"; fi
}

case_robots_measure_live_into_the_daemon() {
  start_daemon
  simulate run 12 --rate max --socket "$work/ingest.sock" --json >"$work/summary.json" 2>/dev/null ||
    fail "$(cat "$work/summary.json")"
  [ "$(field taken <"$work/summary.json")" = 12 ] || fail "$(cat "$work/summary.json")"
  status
  [ "$(mapped voxels_occupied)" -gt 1000 ] || fail "$(cat "$work/status.json")"
  if simulate run 1 --robots 2 --socket "$work/ingest.sock" >/dev/null 2>"$work/err"; then
    fail "two robots took one socket"
  fi
  grep -q "one --socket per robot" "$work/err" || fail "$(cat "$work/err")"
  stop_daemon
}

case_the_ground_can_be_asked_about() {
  local ctl=("$bin/warrenctl" --socket "$work/control.sock")
  start_daemon
  if "${ctl[@]}" query ground 0 0 0 2>"$work/err"; then fail "answered without a map"; fi
  grep -q "no map yet" "$work/err" || fail "$(cat "$work/err")"
  columns=512 simulate run 12 --rate max --socket "$work/ingest.sock" >/dev/null 2>&1 || fail "no run"
  "${ctl[@]}" map save "$work/cost.png" --colours cost >/dev/null
  [ "$(stat -c %s "$work/cost.png")" -gt 10000 ] || fail "cost.png is empty"
  status
  [ "$(mapped cost_up_to_0p10)" -gt 500 ] || fail "no easy ground: $(cat "$work/status.json")"
  [ "$(mapped cost_above_0p20)" -gt 500 ] || fail "no walls: $(cat "$work/status.json")"
  "${ctl[@]}" query ground 1000 0 0 --json >"$work/far.json"
  [ "$(field validity <"$work/far.json")" = unknown ] || fail "$(cat "$work/far.json")"
  "${ctl[@]}" query ground 1000 0 -5 | grep -q 'mean cost *no data' || fail "no table"
  if "${ctl[@]}" query ground 0 0 0 --width 1000 2>/dev/null; then fail "took a footprint of 1 km"; fi
  stop_daemon
}

case_a_world_is_drawn() {
  "$bin/warren-sim" render --world room --out "$work/pictures" 2>/dev/null
  for picture in outside cutaway plan robot; do
    [ "$(stat -c %s "$work/pictures/$picture.png")" -gt 20000 ] || fail "$picture.png is empty"
  done
}

case_the_radio_of_a_world_is_told() {
  "$bin/warren-sim" radio --world tunnel --robots 2 --seconds 20 --out "$work/radio" 2>/dev/null
  head -n 1 "$work/radio/radio.csv" | grep -q '^time_s,from,to,loss,rate_bit_s$' || fail "no header"
  grep -q ',base,robot-1,' "$work/radio/radio.csv" || fail "the base hears no robot"
}

"case_$case"
