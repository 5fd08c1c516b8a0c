#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The example drives, twice the same to the byte where computing costs what is set; on a slow computer, and beside a
# process that eats its time, fewer scans are answered, and later.
# Topics: examples, models, cores, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
# A slow computer may not come to what is expected (status 3).
drive() {
  "$tcsim" run "$build/examples/rover/scenario.yaml" --out "$out/$1" "${@:2}" >"$out/said" 2>&1 ||
    [[ $1 =~ slow|eaten && $? == 3 ]] || fail "$(cat "$out/said")"
}
drive first --accounting fixed --duration 3s
drive second --accounting fixed --duration 3s
cmp "$out/first/bodies.csv" "$out/second/bodies.csv" || fail "a second drive is another one"
drive quick --duration 4s --set robots.rover.cpu.speed=1
drive slow --duration 4s --set robots.rover.cpu.speed=0.1
drive eaten --duration 4s --set robots.rover.cpu.speed=0.1 --set 'robots.rover.clients.eater.command=[./eater, "100"]'
PYTHONDONTWRITEBYTECODE=1 python3 - "$out" "$source_root" <<'PY' || fail "$(cat "$out/said")"
import json, re, statistics, sys
from pathlib import Path
out = Path(sys.argv[1])
sys.path.append(f"{sys.argv[2]}/examples/rover")
import figure, sweep
for name in ("first", "quick"):
    track = sweep.track(out / name, "rover/base_link")
    assert max(row["x_m"] for row in track) > -4.5, "it has not come far"
    assert all(abs(row["z_m"] - 0.1) < 0.02 for row in track), "it does not stand on its wheels"
    assert figure.collisions_per_minute(out / name) == 0, "it collides"
s = json.load(open(out / "quick/summary.json"))
assert s["staleness_ns"] == 0 and s["drift_ns"] <= 1_000_000, s
def answers(name):
    said = (out / name / "rover-local_planner.out.log").read_text()
    return [float(ms) for ms in re.findall(r"after ([0-9.]+) ms", said)]
took = {name: (len(answers(name)), statistics.median(answers(name))) for name in ("quick", "slow", "eaten")}
print(took)
assert took["quick"][0] > 1.5 * took["slow"][0] > 2.0 * took["eaten"][0], took
assert took["eaten"][1] > 1.4 * took["slow"][1] and took["slow"][1] > 4 * took["quick"][1], took
PY
