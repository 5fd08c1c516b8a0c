#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Two crates slide towards each other among others that stand on the same floor: they collide and share
# their momentum, the others stand, and a run that integrates on two processors writes the same bytes.
# Topics: contacts, physics, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
{
  echo "duration: 3s"
  echo "dynamics: {gravity: [0, 0, -9.81]}"
  echo "models:"
  echo "  floor: {plane: [0, 0, 1]}"
  echo "  left: {box: [0.2, 0.2, 0.2], mass: 1, friction: 0.02, position: [-1, 0, 0.1], linear_velocity: [1, 0, 0]}"
  echo "  right: {box: [0.2, 0.2, 0.2], mass: 3, friction: 0.02, position: [1, 0, 0.1], linear_velocity: [-1, 0, 0]}"
  for i in $(seq 20); do
    echo "  crate$i: {box: [0.2, 0.2, 0.2], mass: 1, position: [$i, 2, 0.1]}"
  done
  echo 'robots: {r: {clients: {c: {command: [sleep, "3"]}}}}'
} >"$out/s.yaml"
for cpus in 1 auto; do
  "$tcsim" run "$out/s.yaml" --accounting fixed --host-cpus "$cpus" --out "$out/$cpus" >"$out/said" 2>&1 ||
    fail "$(cat "$out/said")"
done
cmp "$out/1/bodies.csv" "$out/auto/bodies.csv" || fail "with two processors they move otherwise"
python3 - "$out/1/bodies.csv" <<'PY' || fail "they do not move as they should"
import csv, sys
bodies = {}
for row in csv.DictReader(open(sys.argv[1])):
    bodies.setdefault(row["body"], []).append({k: float(v) for k, v in row.items() if k != "body"})
left, right = bodies["left"], bodies["right"]
met = next(i for i, (a, b) in enumerate(zip(left, right)) if b["x_m"] - a["x_m"] < 0.201)
print(f"they meet after {left[met]['time_s']} s")
assert 0.85 < left[met]["time_s"] < 1.05
after = met + 10
both = (left[after]["vx_mps"] + 3 * right[after]["vx_mps"]) / 4
assert abs(both - (-0.5 + 0.5 * 0.02 * 9.81 * left[after]["time_s"])) < 0.03, both
assert all(b["x_m"] - a["x_m"] > 0.19 for a, b in zip(left, right)), "one went through the other"
for i in range(1, 21):
    last = bodies[f"crate{i}"][-1]
    assert abs(last["x_m"] - i) < 1e-6 and abs(last["z_m"] - 0.1) < 1e-3, (i, last)
PY
