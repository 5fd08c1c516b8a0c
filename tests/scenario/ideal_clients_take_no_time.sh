#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# On an ideal robot time stands still while a program computes and goes on while it waits: a bridge answers at the
# instant. What never waits there does not hold the world up for ever.
# Topics: accounting, timers, scenario files.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/computes.py" <<'PY'
import time
for i in range(3):
    begun = time.monotonic_ns(), time.process_time_ns()
    total = sum(k * k for k in range(300_000))
    print(time.monotonic_ns() - begun[0], time.process_time_ns() - begun[1])
    time.sleep(0.25)
print(time.monotonic_ns() - 10**12, flush=True)
PY
cat >"$out/answers.py" <<'PY'
import socket
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 27481))
while True:
    text, peer = s.recvfrom(100)
    sum(k * k for k in range(100_000))
    s.sendto(text, peer)
PY
cat >"$out/asks.py" <<'PY'
import socket, time
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
time.sleep(0.3)
for i in range(5):
    before = time.monotonic_ns()
    s.sendto(b"?", ("127.0.0.1", 27481))
    s.recv(100)
    print(time.monotonic_ns() - before, flush=True)
PY
cat >"$out/s.yaml" <<'YAML'
duration: 1s
robots:
  world: {cpu: ideal, clients: {plant: {command: [python3, computes.py]}, bridge: {command: [python3, answers.py]}}}
  robot: {clients: {asks: {command: [python3, asks.py]}}}
YAML
for accounting in measured fixed; do
  "$tcsim" run "$out/s.yaml" --accounting $accounting --out "$out/$accounting" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  [[ $(head -3 "$out/$accounting/world-plant.out.log") == $'0 0\n0 0\n0 0' ]] || fail "$accounting: computing took time: $(cat "$out/$accounting/world-plant.out.log")"
  [[ $(tail -1 "$out/$accounting/world-plant.out.log") == 750000000 ]] || fail "$accounting: waiting took another time: $(cat "$out/$accounting/world-plant.out.log")"
  # Ten times as long as the asking program's own few calls, and a hundredth of what the answer takes to compute.
  (($(sort -n "$out/$accounting/robot-asks.out.log" | sed -n 3p) < 300000)) || fail "$accounting: an answer took time: $(cat "$out/$accounting/robot-asks.out.log")"
  grep -q '^world/plant  *0.000 s' "$out/said" || fail "$accounting: an ideal client was charged: $(cat "$out/said")"
done
"$tcsim" run "$out/s.yaml" --accounting fixed --out "$out/again" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
for file in trace.json activations.csv dispatches.csv; do cmp "$out/fixed/$file" "$out/again/$file" || fail "$file differs"; done

# A controller behind a bridge that speaks a binary protocol flies.
"$tcsim" run "$source_root/examples/bridge/bridge.yaml" --out "$out/bridge" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
(($(wc -l <"$source_root/examples/bridge/bridge.py") < 50)) || fail "the bridge has grown"
tail -1 "$out/bridge/bodies.csv" | grep -Eq '^5.000000000,drone,0.99[0-9]*,1.99[0-9]*,2.99' || fail "the drone is elsewhere: $(tail -1 "$out/bridge/bodies.csv")"

# One that computes for ever, and two that answer each other's answers.
cat >"$out/talks.py" <<'PY'
import socket, sys
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 27482 + int(sys.argv[1])))
while True:
    s.sendto(b"?", ("127.0.0.1", 27483 - int(sys.argv[1])))
    s.recv(100)
PY
run() {  # NAME COMMANDS SENTENCE
  cat >"$out/$1.yaml" <<YAML
duration: 200ms
patience: 1s
robots:
  world: {cpu: ideal, clients: {$2}}
  robot: {clients: {sleeps: {command: [sleep, "9"]}}}
YAML
  timeout 200 "$tcsim" run "$out/$1.yaml" --accounting fixed --out "$out/$1" >"$out/$1.said" 2>&1 || fail "status $?: $(cat "$out/$1.said")"
  grep -Eq "$3" "$out/$1.said" || fail "$(cat "$out/$1.said")"
}
run talkers 'talker: {command: [python3, talks.py, "0"]}, other: {command: [python3, talks.py, "1"]}' \
  'warning: world/(talker|other) has been busy for 1 s at one instant of virtual time; its robot is ideal, .* from 0.000 s on the world goes on without'
run spinner 'spinner: {command: [python3, -c, "while True: pass"]}' \
  'warning: world/spinner has computed for 1 s at one instant of virtual time; its robot is ideal'
all_done
