#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A talker and a listener as a middleware of ROS 2 makes them, on two processors of the host: each message is heard, in every
# run. (That fixed runs repeat: fixed_dds_repeats.)
# Topics: dds, ros, threads, host processors.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
pair="$build/bin/rmw_pair talker 30 & $build/bin/rmw_pair listener 30; wait"
for run in {1..8}; do
  timeout 200 "$tcsim" exec -- sh -c "$pair" >"$out/said" 2>"$out/errors" ||
    fail "run $run exits with $?: $(cat "$out/errors" "$out/said")"
  # Another run may have the processors first, and this one then says so.
  errors=$(without_waits <"$out/errors")
  [[ $(grep -c ' at .* from ' "$out/said") == 30 && -z $errors ]] || fail "run $run: $(cat "$out/errors" "$out/said")"
done
