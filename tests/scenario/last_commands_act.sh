#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What a program commands in its last turn acts when it was sent, though the run ends with the program: sent by a socket
# whose datagrams need no turn of their own, and through the kernel.
# Topics: commands, ends.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/commands.py" <<'PY'
import os, socket, sys, time
way, to = sys.argv[1:]
s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
if way == "write": s.connect("\0" + to)
# Soon after a step of the world: it has not come so far when the run ends.
time.sleep(0.5003)
command = b'{"force": [0, 0, 2]}'
if way == "write": os.write(s.fileno(), command)
else: s.sendto(command, "\0" + to)
print(time.monotonic_ns() - 1000 * 10**9, flush=True)
os._exit(0)
PY
cat >"$out/s.yaml" <<'YAML'
duration: 10s
dynamics: {}
bodies: {ball: {mass: 1, inertia: [1, 1, 1]}}
robots:
  r: {clients: {c: {command: [python3, commands.py, WAY, '${run}/hands']}}}
channels:
  hands: {type: unix_json, commands: {body: ball, listen: '@${run}/hands'}}
YAML
for way in sendto write; do
  sed "s/WAY/$way/" "$out/s.yaml" >"$out/$way.yaml"
  for accounting in fixed measured; do
    for cpus in 1 auto; do
      timeout 200 "$tcsim" run "$out/$way.yaml" --accounting $accounting --host-cpus $cpus --out "$out/run" >"$out/said" 2>&1 ||
        fail "$way, $accounting: $(cat "$out/said" "$out"/run/*.log)"
      python3 - "$out/run" <<'PY' || fail "$way, $accounting, $cpus: $(cat "$out/said")"
import csv, json, sys
folder = sys.argv[1]
run = json.load(open(folder + "/summary.json"))
after = int(open(folder + "/r-c.out.log").read())
acts = [int(row["acts_ns"]) for row in csv.DictReader(open(folder + "/commands.csv")) if row["quantity"] == "force_z"]
assert run["commands"] == 1 and len(acts) == 1, (run["commands"], acts)
assert 500_300_000 <= acts[0] <= after <= run["virtual_ns"] < 10**9, (acts, after, run["virtual_ns"])
PY
    done
  done
done
