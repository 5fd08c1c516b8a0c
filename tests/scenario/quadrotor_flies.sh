#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The example flies, twice the same to the byte where computing costs what is set; on a slower computer it
# loses more height to the same push. A swarm of three flies, too.
# Topics: examples, models, cores, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
folder=$build/examples/quadrotor
# A slow computer may not come to what is expected (status 3).
fly() {
  "$tcsim" run "$folder/scenario.yaml" --out "$out/$1" "${@:2}" >"$out/said" 2>&1 ||
    [[ $1 == slow && $? == 3 ]] || fail "$(cat "$out/said")"
}
lost() {  # NAME: how far it falls after the push; one that never took off lost all
  awk -F, '$2 == "drone/base_link" { if ($1 <= 6) before = $5; else if (least == "" || $5 < least) least = $5 }
    END { printf "%.4f", (before > 2 ? before : 2) - least }' "$out/$1/bodies.csv"
}
fly first --accounting fixed --duration 7s
fly second --accounting fixed --duration 6.2s  # the push comes at 6 s
cmp -n "$(stat -c %s "$out/second/bodies.csv")" "$out/first/bodies.csv" "$out/second/bodies.csv" || fail "a second flight is another one"
python3 - "$out/first/summary.json" <<'PY' || fail "$(cat "$out/said")"
import json, sys
s = json.load(open(sys.argv[1]))
assert s["virtual_ns"] == 7_000_000_000 and s["staleness_ns"] == 0, s
assert s["commands"] >= 6900, s  # a rate loop of 1 kHz
assert all(c["overruns"] == 0 for c in s["clients"].values()), s
PY
fixed=$(lost first)
awk -v a="$fixed" 'BEGIN { exit !(a > 0.1 && a < 0.5) }' || fail "with fixed costs it loses $fixed m"
fly quick --duration 7s --set robots.drone.cpu.speed=1
fly slow --duration 7s --set robots.drone.cpu.speed=0.05
quick=$(lost quick) slow=$(lost slow)
printf 'height lost: %s m with fixed costs, %s m, %s m on a slow computer\n' "$fixed" "$quick" "$slow"
awk -v a="$quick" -v b="$slow" 'BEGIN { exit !(a > 0.1 && a < 0.5 && b > 1.1 * a) }' || fail "a slow computer loses no more height"
(cd "$folder" && ./swarm.py 3 --hz 250) >"$folder/swarm.$$.yaml"
trap 'rm -rf "$out" "$folder/swarm.$$.yaml"' EXIT
"$tcsim" run "$folder/swarm.$$.yaml" --accounting fixed --duration 4s --out "$out/swarm" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
awk -F, '$1 > 3.9 && $2 ~ /base_link/ && ($5 < 1.9 || $5 > 2.1) { bad = 1 } $2 ~ /base_link/ && $1 > 3.9 { seen[$2] = 1 }
  END { exit bad || length(seen) != 3 }' "$out/swarm/bodies.csv" || fail "the swarm does not hover"
