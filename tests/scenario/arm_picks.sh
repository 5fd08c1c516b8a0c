#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The example takes parts off the belt, twice the same to the byte where computing costs what is set; where
# planning takes longer there, or the computer is slow, parts are missed, and more cores take some of them again.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
pick() {
  "$tcsim" run "$build/examples/arm/scenario.yaml" --out "$out/$1" --duration 40s \
    --set robots.line.clients.belt.command.2=4 "${@:2}" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
}
