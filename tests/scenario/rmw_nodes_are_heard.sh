#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A talker and a listener as a middleware of ROS 2 makes them, on two processors of the host: each message is heard, in every
# run. Under set costs the same comes at the same time from the same writer, byte for byte, however DDS carries it.
# Topics: dds, ros, threads, determinism, host processors.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
pair="$build/bin/rmw_pair talker 30 & $build/bin/rmw_pair listener 30; wait"
for run in {1..8}; do
  timeout 60 "$tcsim" exec -- sh -c "$pair" >"$out/said" 2>"$out/errors" ||
    fail "run $run exits with $?: $(cat "$out/errors" "$out/said")"
  [[ $(grep -c ' at .* from ' "$out/said") == 30 && ! -s $out/errors ]] || fail "run $run: $(cat "$out/errors" "$out/said")"
done
for dds in endpoints sockets; do
  for run in 1 2 3; do
    timeout 60 "$tcsim" exec --accounting fixed --dds "$dds" -- sh -c "$pair" >"$out/$dds$run" 2>&1 ||
      fail "$dds exits with $?: $(cat "$out/$dds$run")"
    cmp "$out/${dds}1" "$out/$dds$run" || fail "two fixed runs differ: $(diff "$out/${dds}1" "$out/$dds$run" | head -4)"
  done
done
