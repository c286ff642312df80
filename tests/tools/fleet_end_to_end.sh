#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A base and robots, the real programs over real UDP. Usage: fleet_end_to_end.sh BIN_DIR SOURCE_DIR CASE
# shellcheck source=tests/tools/end_to_end_parts.sh
. "$(dirname "$0")/end_to_end_parts.sh"
# shellcheck source=tests/tools/fleet_end_to_end_parts.sh
. "$(dirname "$0")/fleet_end_to_end_parts.sh"

case_a_key_that_cannot_be_used_is_told_before_and_at_the_start() {
  printf 'sockets: {ingest: {path: %s}, control: {path: %s}}\nstore: {enabled: false}\n' \
    "$work/ingest" "$work/control" >"$work/robot.yaml"
  printf 'mesh: {key_file: %s, interfaces: [{name: lo}]}\n' "$work/fleet.key" >>"$work/robot.yaml"
  told() { # TEXT
    "$bin/warrend" --check "$work/robot.yaml" >"$work/check.out" 2>"$work/check.err" ||
      fail "the config has faults: $(cat "$work/check.err")"
    grep -q ': fine$' "$work/check.out" || fail "not fine: $(cat "$work/check.out")"
    grep -q "$1" "$work/check.err" || fail "not told before: $(cat "$work/check.err")"
    local status=0
    timeout 20 "$bin/warrend" --config "$work/robot.yaml" 2>"$work/robot.log" || status=$?
    [ "$status" -eq 1 ] || fail "it ended with $status"
    grep -q "$1" "$work/robot.log" || fail "not told at the start"
  }
  told 'warrenctl key new'
  "$bin/warrenctl" key new "$work/fleet.key" || fail "no key was made"
  chmod 644 "$work/fleet.key"
  told 'chmod 600'
  chmod 600 "$work/fleet.key"
  "$bin/warrend" --check "$work/robot.yaml" >"$work/check.out" 2>"$work/check.err"
  [ ! -s "$work/check.err" ] || fail "told for nothing: $(cat "$work/check.err")"
}

case_a_base_has_what_robots_map_that_it_never_hears() {
  start_node robot-1 1
  start_node robot-2 2 1
  start_node base 0 1
  maps_are_shared
  for name in robot-1 robot-2 base; do stop_node "$name"; done
}

# Three of them in one process; they copy nothing and hear only the base.
case_a_base_has_what_light_robots_publish() {
  start_node base 0
  "$bin/warren-bench" peers --robots 3 --seconds 5 --tick-s 0.5 --tape-s 4 --columns 64 --lidar-rate 4 \
    --base "127.0.0.1:$port_base" --key "$work/fleet.key" --port-base "$((30000 + $$ % 340 * 8))" \
    --settle-s 25 --json >"$work/peers.json" 2>"$work/peers.log" || fail "$(cat "$work/peers.json")"
  [ "$(field ticks <"$work/peers.json")" = 30 ] || fail "$(cat "$work/peers.json")"
  for of in light-0 light-1 light-2; do has_all base "$of" || fail "the base has not all of $of"; done
  stop_node base
}

case_a_robot_that_is_killed_comes_back_and_the_fleet_goes_on() {
  start_node robot-1 1
  start_node robot-2 2 1
  start_node base 0 1
  drive robot-1 3 8
  wait_until "the base has all of robot-1" has_all base robot-1
  kill_node robot-1
  drive robot-2 4 8
  start_node robot-1 1
  drive robot-1 3 8 2
  for of in robot-1 robot-2; do wait_until "the base has all of $of" has_all base "$of"; done
  wait_until "robot-2 has all of robot-1" has_all robot-2 robot-1
  same_layer robot-2 base
  for name in robot-1 robot-2 base; do stop_node "$name"; done
}

# One layer, of which the base has all: nothing that left the robot was lost by a kill, and no
# revision was used twice, or the digests would differ.
case_a_robot_killed_while_it_maps_goes_on_with_its_layer() {
  start_node robot-1 1
  start_node base 0 1
  local round
  for round in 1 2 3; do
    "$bin/warren-sim" run --world room --seed "$round" --seconds 20 --columns 128 --rate max \
      --frame-epoch 1 --socket "$work/robot-1.ingest" >/dev/null 2>&1 &
    local driver=$!
    wait_until "robot-1 has published in round $round" has_published robot-1 "$round"
    kill_node robot-1
    wait "$driver" || true
    start_node robot-1 1
  done
  drive robot-1 4 8
  wait_until "the base has all of robot-1" has_all base robot-1
  same_layer robot-1 base
  ctl base fleet status --json || fail "$(cat "$work/base.err")"
  "$python" - "$work/base.out" <<'PY' || fail "$(cat "$work/base.out")"
import json, sys
[robot] = [n for n in json.load(open(sys.argv[1]))["nodes"] if n["name"] == "robot-1"]
sys.exit(0 if len(robot["layers"]) == 1 else 1)
PY
  for name in robot-1 base; do stop_node "$name"; done
}

# Its revision is above that of the round before.
published=0
has_published() { # NAME ROUND
  ctl "$1" status --json || return 1
  local revision
  revision=$("$python" -c 'import json, sys
print(json.load(open(sys.argv[1])).get("publishing", {}).get("revision", 0))' "$work/$1.out")
  [ "$revision" -gt "$((published + 2))" ] || return 1
  published=$revision
}

# What a path or a message watch printed has this in it.
shows() { # NAME TEXT ARG..
  ctl "$1" "${@:3}" && grep -q -- "$2" "$work/$1.out"
}

case_messages_paths_and_orders_cross_the_fleet() { # robot-1 and the base do not hear each other
  start_node robot-1 1 2
  start_node robot-2 2
  start_node base 0 2
  drive robot-1 3 8
  drive robot-2 3 8
  wait_until "the base has all of robot-1" has_all base robot-1
  wait_until "the base has all of robot-2" has_all base robot-2
  wait_until "robot-1 knows the base" ctl robot-1 message send --to base --class urgent "found one"
  wait_until "the base hears robot-1" shows base 'robot-1 (urgent): found one' message watch --seconds 0
  ctl base message send --name plan "come home" || fail "$(cat "$work/base.err")"
  for name in robot-1 robot-2; do
    wait_until "$name hears the base" shows "$name" 'base to all \[plan\]: come home' message watch --seconds 0
  done
  ! ctl robot-1 message send --to nobody hello || fail "a message to nobody was taken"
  grep -q 'no node called nobody' "$work/robot-1.err" || fail "no reason: $(cat "$work/robot-1.err")"

  wait_until "the base has a path of robot-1" shows base ' 0$' fleet trajectory robot-1
  local before after
  before=$(head -n 1 "$work/base.out" | cut -d ' ' -f 2)
  ! ctl robot-2 align robot-1 1 0 0 0 || fail "a robot gave an order"
  grep -q 'only a base' "$work/robot-2.err" || fail "no reason: $(cat "$work/robot-2.err")"
  ctl base align robot-1 -0.6 0.4 0.1 4 || fail "$(cat "$work/base.err")"
  moved() {
    ctl robot-2 fleet trajectory robot-1 || return 1
    after=$(head -n 1 "$work/robot-2.out" | cut -d ' ' -f 2)
    "$python" -c 'import sys; sys.exit(not abs(float(sys.argv[1]) - 0.6 - float(sys.argv[2])) < 0.25)' \
      "$before" "$after"
  }
  wait_until "robot-2 sees robot-1 moved" moved
  # Both robots saw the same room: where robot-1 belongs can be told from that, and is not far off.
  ctl base align robot-1 --estimate --against robot-2 || fail "$(cat "$work/base.out" "$work/base.err")"
  local layer
  layer=$(sed -n 's/.*warrenctl align \([0-9]*\.0\.[0-9a-f]\{16\}\) .*/\1/p' "$work/base.out")
  [ -n "$layer" ] || fail "no command: $(cat "$work/base.out")"
  ctl base align "$layer" -0.6 0.4 0.1 4 || fail "$(cat "$work/base.err")"
  grep -q "about 1 layer as far as known here: $layer" "$work/base.out" || fail "$(cat "$work/base.out")"
  ctl base fleet retract robot-1 || fail "$(cat "$work/base.err")"
  wait_until "robot-2 leaves robot-1 out" shows robot-2 'retracted everywhere' fleet status
  ctl base fleet restore robot-1 || fail "$(cat "$work/base.err")"
  back() { ctl robot-2 fleet status && ! grep -q 'retracted everywhere' "$work/robot-2.out"; }
  wait_until "robot-2 takes robot-1 in again" back
  for name in robot-1 robot-2 base; do stop_node "$name"; done
}

case_a_fleet_that_is_watched_is_shown_again_after_a_restart() {
  shown() { [ "$(wc -l <"$work/watch.out")" -gt "$1" ]; } # LINES
  start_node base 0
  touch "$work/watch.out"
  "$bin/warrenctl" --socket "$work/base.control" fleet status --watch --json \
    >"$work/watch.out" 2>"$work/watch.err" &
  pids[watch]=$!
  wait_until "the fleet is shown twice" shown 1
  stop_node base
  wait_until "the end of the daemon is told" grep -q 'waiting for it' "$work/watch.err"
  local lines
  lines=$(wc -l <"$work/watch.out")
  start_node base 0
  wait_until "the fleet is shown again" shown "$lines"
  kill_node watch
  "$python" -c 'import json, sys
for line in sys.stdin.read().split("\n")[:-1]: assert json.loads(line)["nodes"][0]["name"] == "base"' \
    <"$work/watch.out" || fail "not an object per line: $(cat "$work/watch.out")"
  [ "$(wc -l <"$work/watch.err")" -eq 1 ] || fail "told more than once: $(cat "$work/watch.err")"
  stop_node base
}

case_a_fleet_shares_maps_over_bad_radios() {
  [ "$(id -u)" -eq 0 ] || { echo "SKIPPED: network namespaces need root"; exit 0; }
  [ -c /dev/net/tun ] || { echo "SKIPPED: there is no /dev/net/tun"; exit 0; }
  command -v ip >/dev/null || { echo "SKIPPED: there is no iproute2"; exit 0; }
  "$bin/warren-link" --tap --nodes 3 --rate 2e6 --delay-ms 10 --loss 0.2 \
    --link 0,2,loss=1 --link 2,0,loss=1 >"$work/link.out" 2>"$work/link.log" &
  link=$!
  wait_until "the radios are on" grep -q '^ready' "$work/link.out"
  local node=0 name
  for name in base robot-1 robot-2; do
    namespaces[$name]="warren-$link-$node"
    node=$((node + 1))
  done
  start_node robot-1 1
  start_node robot-2 2
  start_node base 0
  maps_are_shared
  for name in robot-1 robot-2 base; do stop_node "$name"; done
}

"case_$case"
