#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A run that is watched, paused, stepped and paced from its page: steps are exact, what it writes is the
# same to the byte as without all that, and whoever watches badly, or dies, keeps it from nothing.
# Topics: live page, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$tcsim" run "$build/examples/rover/scenario.yaml" --accounting fixed --duration 2s --out "$out/plain" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
cd "$(dirname -- "${BASH_SOURCE[0]}")"
timeout 450 python3 -B live_runs_are_held.py "$tcsim" "$build/examples/rover/scenario.yaml" "$out" || fail "a watched run is not as it should be"
[[ -z $(new_in_shm) ]] || fail "left in /dev/shm: $(new_in_shm)"
