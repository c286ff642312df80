#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The real programs over real sockets. Usage: end_to_end.sh BIN_DIR SOURCE_DIR CASE
set -euo pipefail
bin=$1 source=$2 case=$3
# Debian's own: another in the PATH lacks Debian's python3-protobuf.
python=/usr/bin/python3
work=$(mktemp -d)
daemon=
clean_up() {
  [ -z "$daemon" ] || kill -KILL "$daemon" 2>/dev/null || true
  rm -rf "$work"
}
trap clean_up EXIT

fail() {
  echo "FAILED: $*" >&2
  [ ! -f "$work/warrend.log" ] || tail -n 30 "$work/warrend.log" >&2
  exit 1
}

start_daemon() { # [QUEUE_SCANS]
  cat >"$work/robot.yaml" <<YAML
sockets:
  ingest:
    path: $work/ingest.sock
  control:
    path: $work/control.sock
ingest:
  queue_scans: ${1:-8}
sensors:
  - name: lidar
    max_range_m: 20.0
YAML
  "$bin/warrend" --config "$work/robot.yaml" 2>"$work/warrend.log" &
  daemon=$!
  for _ in $(seq 300); do
    [ -S "$work/control.sock" ] && [ -S "$work/ingest.sock" ] && return
    kill -0 "$daemon" 2>/dev/null || fail "warrend did not start"
    sleep 0.1
  done
  fail "warrend opened no sockets"
}

stop_daemon() {
  kill -TERM "$daemon"
  wait "$daemon" || fail "warrend ended with $?"
  daemon=
}

scene() { # SCANS
  "$bin/warren-scene" --seed 3 --scans "$1" --rings 16 --columns 128 --out "$work/scene"
}

replay() {
  "$bin/warren-replay" --clouds "$work/scene/clouds" --poses "$work/scene/poses.txt" \
    --socket "$work/ingest.sock" --json "$@" 2>"$work/replay.err"
}

field() { # NAME < JSON
  "$python" -c 'import json,sys; print(json.load(sys.stdin)[sys.argv[1]])' "$1"
}
status() { "$bin/warrenctl" --socket "$work/control.sock" status --json >"$work/status.json"; }
mapped() { "$python" -c 'import json,sys; m=json.load(open(sys.argv[1]))["map"]; print(m[sys.argv[2]])' "$work/status.json" "$1"; }

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
  "$bin/warren-scene" --seed 3 --scans 16 --rings 64 --columns 512 --out "$work/scene"
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

case_a_scene_has_the_same_bytes_every_time() {
  scene 3
  mv "$work/scene" "$work/first"
  scene 3
  diff -r "$work/first" "$work/scene" || fail "two runs differ"
  "$bin/warren-scene" --seed 4 --scans 3 --rings 16 --columns 128 --out "$work/other"
  if diff -rq "$work/first" "$work/other" >/dev/null; then fail "two seeds agree"; fi
}

"case_$case"
