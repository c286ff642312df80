#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The real programs and their layers. Usage: layers_end_to_end.sh BIN_DIR SOURCE_DIR CASE
# shellcheck source=tests/tools/end_to_end_parts.sh
. "$(dirname "$0")/end_to_end_parts.sh"

case_layers_go_to_files_and_back() {
  local layer=("$bin/warrenctl" layer)
  scene 10
  start_daemon
  replay --rate max >/dev/null || fail "replay: $(cat "$work/replay.err")"
  for ending in bt ot ply; do
    "$bin/warrenctl" --socket "$work/control.sock" map save "$work/map.$ending" >/dev/null
  done
  stop_daemon
  "${layer[@]}" import "$work/map.bt" "$work/bt.layer" --origin 7 >/dev/null
  "${layer[@]}" import "$work/map.ot" "$work/ot.layer" --origin 7 >/dev/null
  "${layer[@]}" diff "$work/bt.layer" "$work/ot.layer" >"$work/same" || fail "differ: $(cat "$work/same")"
  [ "$("${layer[@]}" digest "$work/bt.layer")" = "$("${layer[@]}" digest "$work/ot.layer")" ] ||
    fail "equal layers, other digests"
  [ "$("${layer[@]}" digest "$work/bt.layer" --regions | wc -l)" -gt 1 ] || fail "no regions"
  [ "$(stat -c %s "$work/bt.layer")" -lt "$(stat -c %s "$work/map.bt")" ] || fail "larger than the tree"
  for ending in bt ot ply pcd; do
    "${layer[@]}" export "$work/bt.layer" "$work/out.$ending" >/dev/null
  done
  "${layer[@]}" import "$work/out.bt" "$work/again.layer" >/dev/null
  "${layer[@]}" diff "$work/bt.layer" "$work/again.layer" >/dev/null || fail "lost on the way"
  [ "$(grep -a '^element vertex' "$work/out.ply")" = "$(grep -a '^element vertex' "$work/map.ply")" ] ||
    fail "the cloud has other voxels"
  printf '# Octomap OcTree binary file\nid OcTree\nsize 0\nres 0.1\ndata\n' >"$work/empty.bt"
  "${layer[@]}" import "$work/empty.bt" "$work/empty.layer" >/dev/null
  local code=0
  "${layer[@]}" diff "$work/bt.layer" "$work/empty.layer" --json >"$work/diff.json" || code=$?
  [ "$code" = 1 ] || fail "exit $code for layers that differ: $(cat "$work/diff.json")"
  [ "$(field only_in_a <"$work/diff.json")" -gt 10000 ] || fail "$(cat "$work/diff.json")"
  code=0
  "${layer[@]}" diff "$work/map.bt" "$work/bt.layer" 2>"$work/err" || code=$?
  [ "$code" = 2 ] || fail "exit $code for what is no layer"
  grep -q "no layer file" "$work/err" || fail "$(cat "$work/err")"
  if "${layer[@]}" export "$work/bt.layer" "$work/out.doc" 2>"$work/err"; then fail "wrote a .doc"; fi
  grep -q '\.ply or \.pcd' "$work/err" || fail "$(cat "$work/err")"
}

case_the_layer_is_watched_and_an_earlier_map_loaded() {
  local ctl=("$bin/warrenctl" --socket "$work/control.sock")
  scene 10
  start_daemon
  "${ctl[@]}" layer watch --seconds 60 >"$work/watched" &
  local watch=$!
  replay --rate max >/dev/null || fail "replay: $(cat "$work/replay.err")"
  wait_until "something is published" published
  "${ctl[@]}" map save "$work/old.layer" >/dev/null
  "${ctl[@]}" map save "$work/old.bt" >/dev/null
  wait_until "the watch shows bytes" grep -qE 'diff-maps (0\.0*[1-9]|[1-9])' "$work/watched"
  stop_daemon
  wait "$watch" || fail "watch ended with $?: $(cat "$work/watched")"
  grep -qE 'in all [0-9]+ s: diff-maps [0-9.]+ kB/s, .* \([0-9.]+ times\)' "$work/watched" ||
    fail "watched: $(cat "$work/watched")"
  forget_store
  start_daemon
  "${ctl[@]}" map load "$work/old.bt" >"$work/loaded"
  grep -qE '[1-9][0-9]* occupied' "$work/loaded" || fail "$(cat "$work/loaded")"
  "${ctl[@]}" map load "$work/old.layer" >/dev/null
  if "${ctl[@]}" map load "$work/old.layer" 2>"$work/err"; then fail "loaded twice"; fi
  grep -q already "$work/err" || fail "$(cat "$work/err")"
  "${ctl[@]}" map save "$work/merged.ply" --merge --colours robot >/dev/null
  grep -aq 'comment source 1' "$work/merged.ply" || fail "no sources in the cloud"
  stop_daemon
}

case_what_is_held_back_is_published_on_demand() {
  local ctl=("$bin/warrenctl" --socket "$work/control.sock")
  scene 10
  start_daemon
  if "${ctl[@]}" layer flush 2>"$work/err"; then fail "flushed without a map"; fi
  grep -q "no map yet" "$work/err" || fail "$(cat "$work/err")"
  replay --rate max >/dev/null || fail "replay: $(cat "$work/replay.err")"
  # No tick is under way once two more have been.
  wait_until "two ticks" ticked "$(($(published_field ticks) + 2))"
  local held_back
  held_back=$(published_field blocks_held_back)
  [ "$held_back" -gt 0 ] || fail "nothing is held back"
  "${ctl[@]}" layer flush >"$work/flushed"
  grep -q "^$held_back blocks were held back and are published now; revision [1-9]" "$work/flushed" ||
    fail "$held_back were held back: $(cat "$work/flushed")"
  [ "$(published_field blocks_held_back)" = 0 ] || fail "something is held back still"
  stop_daemon
}

case_cells_are_asked_about() {
  local ctl=("$bin/warrenctl" --socket "$work/control.sock")
  scene 10
  start_daemon
  replay --rate max >/dev/null || fail "replay: $(cat "$work/replay.err")"
  wait_until "two ticks" ticked "$(($(published_field ticks) + 2))"
  "${ctl[@]}" query box -2 -2 -2 2 2 2 --cell-m 0.4 >"$work/self"
  grep -qE 'occupied, cost .*at worst' "$work/self" || fail "no mixed cell: $(cat "$work/self")"
  grep -qE '^[0-9]+ cells of 0.400 m' "$work/self" || fail "$(cat "$work/self")"
  # What a robot alone knows is its merge-map, but for what is held back.
  "${ctl[@]}" layer flush >/dev/null
  "${ctl[@]}" query box -2 -2 -2 2 2 2 --cell-m 0.4 >"$work/self"
  "${ctl[@]}" query box -2 -2 -2 2 2 2 --depth 14 --merge >"$work/merged"
  diff "$work/self" "$work/merged" || fail "the merge-map of one robot is not its own map"
  "${ctl[@]}" query point 0 0 0 --json >"$work/point.json"
  [ "$("$python" -c 'import json,sys; print(len(json.load(open(sys.argv[1]))["cells"]))' \
    "$work/point.json")" = 1 ] || fail "$(cat "$work/point.json")"
  if "${ctl[@]}" query box -9 -9 -9 9 9 9 2>"$work/err"; then fail "told millions of cells"; fi
  grep -q "at most 4096" "$work/err" || fail "$(cat "$work/err")"
  if "${ctl[@]}" query point 0 0 0 --depth 3 --cell-m 1 2>/dev/null; then fail "took two sizes"; fi
  stop_daemon
}

case_a_loaded_layer_is_retracted_restored_and_moved() {
  local ctl=("$bin/warrenctl" --socket "$work/control.sock")
  scene 10
  start_daemon
  replay --rate max >/dev/null || fail "replay: $(cat "$work/replay.err")"
  "${ctl[@]}" map save "$work/old.bt" >/dev/null
  stop_daemon
  forget_store
  rm -r "$work/scene"
  scene 3
  start_daemon
  replay --rate max >/dev/null || fail "replay: $(cat "$work/replay.err")"
  wait_until "two ticks" ticked "$(($(published_field ticks) + 2))"
  local ending
  save_merged() { # NAME
    for ending in bt ot ply pcd png; do
      "${ctl[@]}" map save "$work/$1.$ending" --merge --colours cost >/dev/null
    done
  }
  same() { # NAME NAME
    for ending in bt ot ply pcd png; do cmp "$work/$1.$ending" "$work/$2.$ending" || return; done
  }
  save_merged before
  "${ctl[@]}" map load "$work/old.bt" >"$work/loaded"
  save_merged loaded
  if same before loaded >/dev/null; then fail "the load changed nothing"; fi
  local id
  id=$(cut -d ' ' -f 1 "$work/loaded")
  "${ctl[@]}" map retract "${id%????}" >/dev/null
  "${ctl[@]}" status | grep -q "$id of $work/old.bt: .* retracted" || fail "status does not tell"
  save_merged retracted
  same before retracted || fail "a retracted layer left something behind"
  "${ctl[@]}" map restore old.bt >/dev/null
  save_merged restored
  same loaded restored || fail "a restored layer is another"
  "${ctl[@]}" map move "$work/old.bt" 1 -2 0 30 >"$work/moved"
  grep -q "in the merge-map" "$work/moved" || fail "$(cat "$work/moved")"
  save_merged moved
  if same loaded moved >/dev/null; then fail "the move changed nothing"; fi
  "${ctl[@]}" map move old.bt 0 0 0 0 >/dev/null
  save_merged back
  same loaded back || fail "a layer that was moved back is another"
  if "${ctl[@]}" map move old.bt 2e9 0 0 0 2>"$work/err"; then fail "moved out of the world"; fi
  grep -q "1e8 m" "$work/err" || fail "$(cat "$work/err")"
  if "${ctl[@]}" map retract new.bt 2>"$work/err"; then fail "retracted what is not there"; fi
  grep -q "no loaded layer is called new.bt" "$work/err" || fail "$(cat "$work/err")"
  stop_daemon
}

"case_$case"
