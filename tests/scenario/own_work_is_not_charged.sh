#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What the shim does for calls besides what the program asks for is neither charged nor lost: the charge and tcs's own work are
# together what the kernel says that the program has used; with rights and without. Under set costs none is told.
# Topics: accounting.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chmod 777 "$out"
cp "$build/bin/short_calls" "$out"
chmod 755 "$out/short_calls"
printf 'duration: 20s\nrobots:\n  r:\n    clients:\n      calls: {command: [%s/short_calls, "100000"]}\n' "$out" >"$out/world.yaml"
call() {  # NAME COMMAND...
  local name=$1
  shift
  timeout 200 "$@" run "$out/world.yaml" --out "$out/$name" >"$out/said" 2>&1 || fail "$name: $(cat "$out/said" "$out/$name"/*.log)"
}
for name in measured contained; do
  as=("$tcsim")
  [[ $name != contained ]] || as=("$source_root/tests/conformance/without_rights.sh" --in-container "$build")
  call "$name" "${as[@]}"
  python3 - "$out/$name" <<'PY' || fail "$name: $(cat "$out/said")"
import json, sys
folder = sys.argv[1]
client = json.load(open(folder + "/summary.json"))["clients"]["r/calls"]
used = int(open(folder + "/r-calls.out.log").read())
charged, own = client["charged_ns"] - client["priced_ns"], client["own_work_ns"]
print(f"{folder}: used {used / 1e6:.1f} ms, charged {charged / 1e6:.1f}, own work {own / 1e6:.1f}")
# What the program used before and after it measured is on both.
assert 0.95 * used <= charged + own <= 1.05 * used + 10e6, (used, charged, own)
assert own >= 0.3 * charged, (charged, own)
PY
done
timeout 200 "$tcsim" run --accounting fixed "$out/world.yaml" --out "$out/fixed" >"$out/said" 2>&1 || fail "fixed: $(cat "$out/said")"
python3 - "$out/fixed" <<'PY' || fail "under set costs"
import json, sys
client = json.load(open(sys.argv[1] + "/summary.json"))["clients"]["r/calls"]
assert client["own_work_ns"] == 0 and client["charged_ns"] >= 300_000 * 1_000, client
PY
