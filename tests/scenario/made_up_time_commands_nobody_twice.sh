#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A program commands a rotor on and on while the processor is taken away from it again and again. Where what was stolen is
# made good its clock stands still, so that commands have one time though it computed in between: nothing is said of that. Two
# programs that command a rotor at one instant are named.
# Topics: commands, host processors, accounting.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cp "$(dirname -- "${BASH_SOURCE[0]}")/craft.urdf" "$out"
cat >"$out/on_and_on.py" <<'PY'
import os, socket, sys, time
commands = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
print(os.getpid(), file=sys.stderr, flush=True)
end = time.monotonic() + 1.5
while time.monotonic() < end:
    commands.sendto(b'{"left": 0.5}', (sys.argv[1], 27431))
PY
cat >"$out/once.py" <<'PY'
import socket, sys, time
commands = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
time.sleep(0.5 - time.monotonic() % 0.5)
commands.sendto(b'{"left": 0.5}', (sys.argv[1], 27431))
time.sleep(10)
PY
scenario() {  # DURATION, ROBOTS
  cat <<YAML
duration: $1
dynamics: {}
models:
  craft: {urdf: craft.urdf, rotors: {left: {link: base, thrust: 1e-5, time_constant: 50ms, limit: 1000}}}
robots: $2
channels:
  motors: {type: udp_json, commands: {model: craft, rotors: [left], drive: normalised, listen: "\${loopback}:27431"}}
YAML
}
again="already had a command"
client() { printf "{cpu: %s, clients: {c: {command: [python3, %s.py, '\${loopback}']}}}" "$1" "$2"; }

scenario 1s "{one: $(client ideal once), other: $(client ideal once)}" >"$out/two.yaml"
"$tcsim" run "$out/two.yaml" --accounting fixed --out "$out/two" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
grep -q "rotor 'left' of craft was commanded once at an instant for which it $again, first at 0.5" "$out/said" ||
  fail "two at one instant are not named: $(cat "$out/said")"

scenario 100s "{one: $(client '{cores: 1}' on_and_on)}" >"$out/one.yaml"
"$tcsim" run "$out/one.yaml" --out "$out/one" >"$out/said" 2>&1 &
run=$!
pid=''
while [[ -z $pid ]]; do
  [[ -e /proc/$run ]] || fail "$(cat "$out/said")"
  sleep 0.02
  pid=$(head -n 1 "$out/one/one-c.err.log" 2>/dev/null) || true
done
thief=0
"$build/bin/processor_thief" interrupts "$pid" || thief=$?
wait "$run" || fail "$(cat "$out/said")"
[[ $thief != 77 ]] || exit 77
python3 - "$out/one" <<'PY' || exit 77
# Were there such commands at all? Where nothing was stolen that no clock had told of, there may be none.
import csv, sys
sent = [int(row["sent_ns"]) for row in csv.DictReader(open(sys.argv[1] + "/commands.csv"))]
same = sum(a == b for a, b in zip(sent, sent[1:]))
print(len(sent), "commands,", same, "at the instant of the one before")
assert len(sent) > 1000
sys.exit(same == 0)
PY
! grep -q "$again" "$out/said" || fail "said of one that computed in between: $(grep "$again" "$out/said")"
