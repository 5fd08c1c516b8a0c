#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The example flies: drift within its bound, every client served, charges as the CPU clocks say.
# Topics: examples, drift, accounting, dds.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$tcsim" run "$build/examples/predator_prey/scenario.yaml" --duration 3s --out "$out" >"$out/said"
python3 - "$out/summary.json" <<'PY' || fail "$(cat "$out/said")"
import json, sys
s = json.load(open(sys.argv[1]))
assert s["virtual_ns"] == 3_000_000_000, s
assert 0 < s["drift_ns"] <= 1_000_000, s
assert s["staleness_ns"] == 0, s
assert s["commands"] >= 500, s  # two controllers at 100 Hz
charged = sum(c["charged_ns"] - c["priced_ns"] for c in s["clients"].values())
own = sum(c["host_cpu_ns"] for c in s["clients"].values())
assert charged > 1_500_000_000 and abs(charged - own) < 0.01 * own, (charged, own)
PY
# The predator is on DDS: the robot's topics, and those on which its programs talk.
topics=$("$tcsim" topics "$out")
for line in '/predator/odom .* 100 Hz +0 +tcsim +predator/controller' '/prey/odom .* 100 Hz +0 +tcsim +predator/controller' \
  '/predator/wrench .* (99[.]|10)[0-9.]* Hz +0 +predator/controller +tcsim' '/predator/plan_request +predator_prey_msgs/msg/PlanRequest +[23] '; do
  grep -Eq "^$line" <<<"$topics" || fail "no line '$line' in: $topics"
done
(($(wc -l <"$out/bodies.csv") > 600)) || fail "the body states are missing"
