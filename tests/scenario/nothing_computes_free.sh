#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A program that says by its memory that it has not computed is charged what the kernel says that it has, with rights and
# without, on one processor of the host's and on two. What it computes between two exchanges it may call these, of which each
# takes 0.05 ms at most; and of what it does in system calls, three quarters its shim's work.
# Topics: accounting, isolation.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chmod 777 "$out"
cp "$build/bin/free_rider" "$out"
chmod 755 "$out/free_rider"
printf 'duration: 20s\nrobots:\n  r:\n    clients:\n      rider: {command: [%s/free_rider, WAY, "1"]}\n' "$out" >"$out/world.yaml"
ride() {  # NAME WAY LEAST COMMAND...
  local name=$1 way=$2 least=$3
  shift 3
  sed "s/WAY/$way/" "$out/world.yaml" >"$out/$name.yaml"
  timeout 200 "$@" run "$out/$name.yaml" --out "$out/$name" >"$out/said" 2>&1 || fail "$name: $(cat "$out/said" "$out/$name"/*.log)"
  python3 - "$out/$name" "$least" <<'PY' || fail "$name: $(cat "$out/said")"
import json, sys
folder, least = sys.argv[1], float(sys.argv[2])
run = json.load(open(folder + "/summary.json"))
charged, computed = run["clients"]["r/rider"]["charged_ns"], int(open(folder + "/r-rider.out.log").read())
print(f"{folder}: charged {charged / 1e9:.3f} of {computed / 1e9:.3f} s")
assert computed >= 1e9 and least * computed <= charged <= 1.1 * computed + 2e7, (charged, computed)
assert run["virtual_ns"] >= charged, run["virtual_ns"]
PY
}
for way in honest origin clock note calls; do
  least=0.95
  # Believed besides: 10 ms of the shim's own work, and what the kernel's books say of system calls, in ticks of 10 ms.
  [[ $way != origin ]] || least=0.9
  [[ $way != note ]] || least=0.7
  [[ $way != calls ]] || least=0.15
  ride "$way" $way $least "$tcsim"
  ride "$way-contained" $way $least "$source_root/tests/conformance/without_rights.sh" --in-container "$build"
done
