#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What the cases of fleet_end_to_end.sh share: nodes that start, drive, end, and what they have.

declare -A pids=()      # of the daemons, by name
declare -A namespaces=() # by name; none: this one, over the loopback interface
link=                   # pid of warren-link
port_base=$((10000 + $$ % 2500 * 8))

clean_up_fleet() {
  for name in "${!pids[@]}"; do kill -KILL "${pids[$name]}" 2>/dev/null || true; done
  [ -z "$link" ] || kill -TERM "$link" 2>/dev/null || true
  [ -z "$link" ] || wait "$link" 2>/dev/null || true
  clean_up
}
trap clean_up_fleet EXIT

fail() {
  echo "FAILED: $*" >&2
  for log in "$work"/*.log; do echo "== $log" >&2; tail -n 20 "$log" >&2; done
  exit 1
}

interface_of() { # NAME NUMBER [SEED_NUMBER..]
  local name=$1
  shift 2
  if [ -n "${namespaces[$name]:-}" ]; then
    printf '    - name: radio0\n'
    return
  fi
  printf '    - name: lo\n      seeds: ['
  local separator=
  for seed in "$@"; do
    printf "%s'127.0.0.1:%s'" "$separator" "$((port_base + seed))"
    separator=', '
  done
  printf ']\n'
}

start_node() { # NAME NUMBER [SEED_NUMBER..]
  local name=$1 number=$2 role=robot group=$2
  # On one interface all hear the group: there each node has one for itself, and seeks by address.
  [ -z "${namespaces[$name]:-}" ] || group=0
  [ "$name" = base ] && role=base
  [ -f "$work/fleet.key" ] || "$bin/warrenctl" key new "$work/fleet.key" >/dev/null
  {
    printf 'node: {name: %s, role: %s}\n' "$name" "$role"
    printf 'sockets:\n  ingest: {path: %s}\n  control: {path: %s}\n' \
      "$work/$name.ingest" "$work/$name.control"
    printf 'store: {file: %s}\n' "$work/$name.db"
    printf 'layer: {tick_s: 0.2, flush_after_s: 1}\n'
    printf 'mesh:\n  key_file: %s\n  port: %s\n  group_port: %s\n  interfaces:\n' \
      "$work/fleet.key" "$((port_base + number))" "$((port_base + 4 + group))"
    interface_of "$@"
  } >"$work/$name.yaml"
  "$bin/warrend" --check "$work/$name.yaml" >/dev/null || fail "the config of $name has faults"
  local in=()
  [ -z "${namespaces[$name]:-}" ] || in=(ip netns exec "${namespaces[$name]}")
  "${in[@]}" "$bin/warrend" --config "$work/$name.yaml" 2>>"$work/$name.log" &
  pids[$name]=$!
  wait_until "$name opens its socket" [ -S "$work/$name.control" ]
  wait_until "$name answers" ctl "$name" fleet status --json
}

stop_node() { # NAME
  kill -TERM "${pids[$1]}"
  wait "${pids[$1]}" || fail "$1 ended with $?"
  unset "pids[$1]"
}

kill_node() { # NAME
  kill -KILL "${pids[$1]}"
  wait "${pids[$1]}" 2>/dev/null || true
  unset "pids[$1]"
}

ctl() { # NAME ARG..
  "$bin/warrenctl" --socket "$work/$1.control" "${@:2}" >"$work/$1.out" 2>"$work/$1.err"
}

drive() { # NAME SEED SWEEPS [FRAME_EPOCH]
  "$bin/warren-sim" run --world room --seed "$2" --seconds "$(($3 / 10)).$(($3 % 10))5" --columns 128 \
    --rate max --frame-epoch "${4:-1}" --socket "$work/$1.ingest" --json >"$work/drive.json" 2>"$work/drive.err" ||
    fail "$1 does not drive: $(cat "$work/drive.err")"
  [ "$(field taken <"$work/drive.json")" = "$3" ] || fail "$(cat "$work/drive.json")"
}

# NAME has all of the layer that OF writes now, with its digest, if any revision of it was ever made.
has_all() { # NAME OF
  ctl "$1" fleet status --json || return 1
  "$python" - "$work/$1.out" "$2" <<'PY'
import json, sys
nodes = json.load(open(sys.argv[1]))["nodes"]
layers = [layer for node in nodes if node["name"] == sys.argv[2] for layer in node["layers"]]
has_all = [layer for layer in layers if layer.get("up_to_us") and layer["latest"] > 0
           and layer["lag_revisions"] == 0 and layer.get("digest_equal")]
sys.exit(0 if has_all else 1)
PY
}

# What a node writes is, byte for byte, what another has of it.
# The writer may publish what it held back between a look at the one and at the other.
same_layer() { # WRITER OTHER
  wait_until "$2 has the map of $1 as $1 has it" same_digest "$1" "$2"
}

same_digest() { # WRITER OTHER
  ctl "$1" map save "$work/own.layer" || fail "$(cat "$work/$1.err")"
  ctl "$2" map save "$work/copy.layer" --of "$1" || fail "$(cat "$work/$2.err")"
  local own copy
  own=$("$bin/warrenctl" layer digest "$work/own.layer")
  copy=$("$bin/warrenctl" layer digest "$work/copy.layer")
  [ "$own" = "$copy" ]
}

maps_are_shared() { # after all three are up; robot-2 and the base do not hear each other
  drive robot-1 3 12
  drive robot-2 4 12
  for of in robot-1 robot-2; do wait_until "the base has all of $of" has_all base "$of"; done
  wait_until "robot-1 has all of robot-2" has_all robot-1 robot-2
  wait_until "robot-2 has all of robot-1" has_all robot-2 robot-1
  same_layer robot-1 base
  same_layer robot-2 base
  ctl base fleet status || fail "$(cat "$work/base.err")"
  grep -Eq '^robot-2 +robot +by others .*has all of robot-2 up to .*digest equal' "$work/base.out" ||
    fail "$(cat "$work/base.out")"
  grep -Eq '^robot-1 +robot +(lo|radio0) .*digest equal' "$work/base.out" ||
    fail "$(cat "$work/base.out")"
  ctl base map save "$work/all.ply" --of merge || fail "$(cat "$work/base.err")"
  for source in 1 2; do
    grep -Eaq "comment source $source: .* robot-[12]\$" "$work/all.ply" ||
      fail "the merged cloud is not of two robots"
  done
}
