#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The example flies, twice the same to the byte where computing costs what is set; on a slower computer it
# keeps its height worse. A swarm of three flies, too.
# Topics: examples, models, cores, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
folder=$build/examples/quadrotor
# A slow computer may not come to what is expected (status 3).
fly() {
  "$tcsim" run "$folder/scenario.yaml" --out "$out/$1" "${@:2}" >"$out/said" 2>&1 ||
    [[ $1 == slow && $? == 3 ]] || fail "$(cat "$out/said")"
}
# How far from its height of 2 m it is. On a slow computer it climbs and falls as it happens, or never takes off.
astray() {  # NAME: root mean square, in m, from 3 s on
  awk -F, '$2 == "drone/base_link" && $1 > 3 { sum += ($5 - 2) ^ 2; ++n } END { printf "%.4f", sqrt(sum / n) }' "$out/$1/bodies.csv"
}
lost() {  # NAME: how far it falls after the push
  awk -F, '$2 == "drone/base_link" { if ($1 <= 6) before = $5; else if (least == "" || $5 < least) least = $5 }
    END { printf "%.4f", before - least }' "$out/$1/bodies.csv"
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
quick=$(lost quick)
awk -v a="$quick" 'BEGIN { exit !(a > 0.1 && a < 0.5) }' || fail "measured it loses $quick m"
quick=$(astray quick) slow=$(astray slow)
printf 'astray by %s m, and by %s m on a slow computer\n' "$quick" "$slow"
awk -v a="$quick" -v b="$slow" 'BEGIN { exit !(b > 1.3 * a) }' || fail "a slow computer keeps its height as well"
(cd "$folder" && ./swarm.py 3 --hz 250) >"$folder/swarm.$$.yaml"
trap 'rm -rf "$out" "$folder/swarm.$$.yaml"' EXIT
"$tcsim" run "$folder/swarm.$$.yaml" --accounting fixed --duration 4s --out "$out/swarm" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
awk -F, '$1 > 3.9 && $2 ~ /base_link/ && ($5 < 1.9 || $5 > 2.1) { bad = 1 } $2 ~ /base_link/ && $1 > 3.9 { seen[$2] = 1 }
  END { exit bad || length(seen) != 3 }' "$out/swarm/bodies.csv" || fail "the swarm does not hover"
