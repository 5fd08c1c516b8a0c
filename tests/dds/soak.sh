#!/usr/bin/env bash
# soak.sh BUILD SAMPLES: the soak's four programs (soak/main.cc) on three robots write so many
# samples. Measured, each finds what it was promised; under fixed accounting two runs agree to the
# byte, in what the programs have seen and when, and in who ran when.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/soak/scenario.sh"
build=$(realpath -- "$1") samples=$2
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
soak_scenario "$build" "$samples" >"$work/scenario.yaml"

# soaks NAME ACCOUNTING: into $work/NAME.
soaks() {
  local out=$work/$1
  "$build/bin/tcsim" run "$work/scenario.yaml" --accounting "$2" --out "$out" >"$out.said" 2>&1 ||
    fail "$2: $(cat "$out.said" "$out"/*.err.log)"
  local ended
  ended=$(grep -o '"wait_status": [0-9]*' "$out/summary.json" | cut -d ' ' -f 2 | xargs)
  [[ $ended == "0 0 0 0" ]] || fail "$2: the programs ended with $ended: $(cat "$out"/*.err.log)"
  echo "$2: $(grep -h 'x real time' "$out.said")"
  grep -h 'DDS samples' "$out.said" || true
  cat "$out"/*.out.log
}
soaks measured measured
soaks first fixed
soaks second fixed >/dev/null
for file in trace.json activations.csv dispatches.csv topics.json left-zero.out.log left-one.out.log \
  middle-two.out.log right-three.out.log; do
  cmp "$work/first/$file" "$work/second/$file" || fail "two fixed runs differ in $file"
done
# They agree because nothing was measured, not because nothing happened.
(($(wc -l <"$work/first/dispatches.csv") > samples / 100)) || fail "there are no dispatches"
grep -q '"ph":"X"' "$work/first/trace.json" || fail "the trace is empty"
echo "two fixed runs of $samples samples: the same $(cat "$work"/first/{trace.json,*.csv} | wc -c) bytes"
