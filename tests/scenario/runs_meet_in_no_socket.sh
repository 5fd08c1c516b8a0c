#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Two runs of one scenario at once, from one folder, and of another example beside them: each has sockets of its own, so
# that with fixed costs each writes the same bytes as a run alone.
# Topics: determinism, unix sockets, examples.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
fly() {  # EXAMPLE NAME DURATION
  "$tcsim" run "$build/examples/$1/scenario.yaml" --accounting fixed --duration "$3" --out "$out/$1-$2" >"$out/$1-$2.said" 2>&1
}
same() { diff -rq --exclude=summary.json "$out/$1" "$out/$2" >"$out/diff" || fail "$1 and $2 differ: $(cat "$out/diff")"; }
at_once() {  # DURATION EXAMPLE...: each twice
  local runs=() names=() example length=$1
  for example in "${@:2}"; do
    for name in one two; do
      fly "$example" $name "$length" & runs+=($!) names+=("$example-$name")
    done
  done
  for i in "${!runs[@]}"; do wait "${runs[$i]}" || fail "${names[$i]}: $(cat "$out/${names[$i]}.said")"; done
  for example in "${@:2}"; do
    fly "$example" alone "$length" || fail "$(cat "$out/$example-alone.said")"
    same "$example-one" "$example-alone"
    same "$example-two" "$example-alone"
    python3 -c 'import json, sys; s = json.load(open(sys.argv[1])); assert s["commands"] > 30, s' "$out/$example-one/summary.json"
  done
}
at_once 1.5s quadrotor rover
at_once 1.5s predator_prey
