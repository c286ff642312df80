# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# What end-to-end tests share: they source this with the arguments BIN_DIR SOURCE_DIR CASE.
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
store:
  file: $work/warren.db
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

# The next life of the daemon begins with nothing.
forget_store() { rm -f "$work"/warren.db*; }

simulate() { # SUBCOMMAND SWEEPS [ARG..]
  local subcommand=$1 sweeps=$2
  "$bin/warren-sim" "$subcommand" --world room --seed 3 --seconds "$((sweeps / 10)).$((sweeps % 10))5" \
    --columns "${columns:-128}" "${@:3}"
}

scene() { # SWEEPS
  simulate record "$1" --out "$work/scene" --drivability-spacing 0 2>/dev/null
}

replay() {
  "$bin/warren-replay" --clouds "$work/scene/robot-0/clouds" --poses "$work/scene/robot-0/poses.txt" \
    --socket "$work/ingest.sock" --json "$@" 2>"$work/replay.err"
}

wait_until() { # WHAT COMMAND..; for at most half a minute
  local what=$1
  shift
  for _ in $(seq 300); do
    if "$@"; then return; fi
    sleep 0.1
  done
  fail "waited in vain: $what"
}

field() { # NAME < JSON
  "$python" -c 'import json,sys; print(json.load(sys.stdin)[sys.argv[1]])' "$1"
}
published_field() { # NAME
  status
  "$python" -c 'import json,sys; print(json.load(open(sys.argv[1]))["publishing"][sys.argv[2]])' \
    "$work/status.json" "$1"
}
published() { [ "$(published_field revision)" -gt 0 ]; }
ticked() { [ "$(published_field ticks)" -ge "$1" ]; } # TICKS
status() { "$bin/warrenctl" --socket "$work/control.sock" status --json >"$work/status.json"; }
mapped() { "$python" -c 'import json,sys; m=json.load(open(sys.argv[1]))["map"]; print(m[sys.argv[2]])' "$work/status.json" "$1"; }
