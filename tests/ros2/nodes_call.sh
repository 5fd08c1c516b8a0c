#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Services, actions with feedback and cancellation, and parameters, between two processes of rclcpp: the same answers natively and
# under tcs, in exactly the time that the action takes.
build_nodes
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT
use_folder "$out"
session="$nodes/calls server & server=\$!; $nodes/calls client; status=\$?; kill \$server; wait \$server; exit \$status"
answers=$'100 sums\na goal: 6 numbers, 6 times told, 0.7 s\na cancelled one: cancelled, 3 numbers'
timeout 60 bash -c "$session" >"$out/said" 2>&1 || fail "natively: $(cat "$out/said")"
[[ $(grep -v '^\[INFO\]' "$out/said") == "$answers" ]] || fail "natively: $(cat "$out/said")"
for accounting in measured fixed; do
  for dds in endpoints sockets; do
    timeout 300 "$tcsim" exec --accounting "$accounting" --dds "$dds" -- bash -c "$session" >"$out/said" 2>&1 ||
      fail "$accounting, $dds: $(cat "$out/said")"
    [[ $(without_waits <"$out/said" | grep -v '^\[INFO\]') == "$answers" ]] || fail "$accounting, $dds: $(cat "$out/said")"
  done
done
