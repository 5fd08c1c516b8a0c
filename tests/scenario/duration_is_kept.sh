#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A run of programs that never end lasts exactly its duration, with a world and without one: whether
# they wait for what never comes, sleep beyond the end, or compute.
# Topics: ends.
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT
mkfifo "$out/never"

lasts() {  # NAME SECONDS ACCOUNTING [WORLD]: exactly so long, and nobody has failed
  printf '%s\n' "duration: $2s" "${4:-}" "robots: {r: {clients: {$clients}}}" >"$out/$1.yaml"
  timeout 200 "$tcsim" run "$out/$1.yaml" --accounting "$3" --sync "${sync:-consistent}" --out "$out/$1" >"$out/$1.said" 2>&1 ||
    fail "$1 $3: status $?: $(cat "$out/$1.said")"
  python3 - "$out/$1/summary.json" "$2" <<'PY' || fail "$1 $3: $(cat "$out/$1.said")"
import json, sys
summary = json.load(open(sys.argv[1]))
assert summary["virtual_ns"] == round(float(sys.argv[2]) * 1e9), summary["virtual_ns"]
assert not summary["interrupted"]
assert all(c["ended_at_ns"] == -1 for c in summary["clients"].values()), summary["clients"]
PY
}

# Without a timeout: a signal, a descriptor, a lock, a child that waits itself.
waiting='signal: {command: [python3, -c, "import signal; signal.pause()"]},
 pipe: {command: [python3, -c, "import os; r, w = os.pipe(); os.read(r, 1)"]},
 lock: {command: [python3, -c, "import threading; l = threading.Lock(); l.acquire(); l.acquire()"]},
 child: {command: [sh, -c, "sleep infinity; true"]}'
# Where the kernel keeps one, and nobody can say for how long, the run still ends.
held="held: {command: [sh, -c, \"cat $out/never; true\"]}"
sleeping='round: {command: [sh, -c, "while :; do sleep 0.7; done"]}, long: {command: [sleep, "7200"]}'
computing='busy: {command: [sh, -c, "while :; do :; done"]}'
world=$'dynamics: {}\nbodies: {b: {mass: 1, inertia: [1, 1, 1]}}'
# Also where the world waits for who computes: for so long as the run's patience is, and no longer.
clients="$waiting, $computing" sync=callback lasts held_up 1.5 measured "$world"$'\npatience: 2s'
grep -q 'r/busy has computed for 2 s at one instant' "$out/held_up.said" || fail "$(cat "$out/held_up.said")"
for accounting in measured fixed; do
  clients=$waiting lasts waiting 3 "$accounting"
  clients=$waiting lasts waiting 3 "$accounting" "$world"
  clients=$held lasts held 0.4 "$accounting"
  clients=$sleeping lasts sleeping 59.3 "$accounting"
  clients=$sleeping lasts sleeping 5.25 "$accounting" "$world"
done
clients="$waiting, $computing" lasts computing 1.5 measured
looking='looks: {command: [python3, -c, "import time\nwhile True: time.monotonic()"]}'
clients="$sleeping, $looking" sync=callback lasts looking 1.5 fixed

# It ends earlier where all programs have ended.
clients='a: {command: [sh, -c, "for i in 1 2 3; do sleep 1; echo $i; done"]}'
printf '%s\n' 'duration: 100s' "robots: {r: {clients: {$clients}}}" >"$out/ends.yaml"
timeout 200 "$tcsim" run "$out/ends.yaml" --out "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
grep -q 'ended before its 100.000 s because all programs had ended' "$out/said" || fail "$(cat "$out/said")"
python3 -c '
import json, sys
ns = json.load(open(sys.argv[1]))["virtual_ns"]
assert 3e9 <= ns < 3.5e9, ns' "$out/run/summary.json"
all_done
