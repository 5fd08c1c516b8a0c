#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Whoever is late is named at the end of a run, with the number and the cause: a controller that computes longer than its
# sensor's period, one that others keep from its core, one that gets none of it. Who keeps up is not. Response times are
# what the set costs make them, to the nanosecond.
# Topics: verdict, scheduling.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out"
"$tcsim" new hover >/dev/null
cd hover
said() { timeout 200 "$tcsim" run "$@" >"$out/said" 2>&1 || fail "$(cat "$out/said")"; }
says() { grep -q -- "$1" "$out/said" || fail "nobody said '$1': $(cat "$out/said")"; }

# What keeps up is not worth a sentence.
said --duration 2s --accounting fixed --out "$out/well"
! grep '^! ' "$out/said" || fail "it kept up"
says '10 ms *0 of 1[89][0-9]'

# 15 ms of computing for each sample of a sensor of 100 Hz. Half the program's own time, so that no clock is read meanwhile.
sed -i 's/^    force\[2\] +=/    burn(0.015)\n    force[2] +=/; s/^import json/import json, time/' controller.py
sed -i 's/^MASS/def burn(seconds):\n    until = time.thread_time() + seconds\n    while time.thread_time() < until: pass\n\nMASS/' controller.py
for accounting in fixed measured; do
  [[ $accounting == fixed ]] && seconds=6 || seconds=3
  said --duration "${seconds}s" --accounting $accounting --out "$out/slow-$accounting"
  says 'hover/controller missed all [0-9]* of its deadlines (10 ms, the period of sensors).*: it computes 1[456]\.\?[0-9]* ms each time, 1[456][0-9] % of a core'
  says 'hover/controller sent commands made of samples up to \([12]\.\?[0-9]* s\|[5-9][0-9]* ms\) old'
  says 'hover/controller never read [0-9]* of [0-9]* datagrams from sensors'
  python3 - "$out/slow-$accounting" "$seconds" <<'PY' || fail "the figures of a slow controller"
import csv, json, sys
summary = json.load(open(sys.argv[1] + "/summary.json"))
seconds = int(sys.argv[2])
figures = summary["clients"]["hover/controller"]
assert summary["verdict"][0].startswith("hover/controller missed all"), summary["verdict"]
[sensors] = figures["inputs"]
assert sensors["from"] == "sensors" and sensors["sent"] == sensors["received"] + sensors["lost"] + sensors["unread"], sensors
assert sensors["sent"] > 90 * seconds - 40 and 0.6 < sensors["received"] / sensors["sent"] < 0.75, sensors
# Each sample was released when it came into the socket, at a whole 10 ms; and the oldest is as old as it waited.
rows = [r for r in csv.DictReader(open(sys.argv[1] + "/activations.csv")) if r["client"] == "hover/controller"]
samples = [r for r in rows if r["cause"] == "input" and int(r["release_ns"]) % 10_000_000 == 0 and int(r["charged_ns"]) > 10_000_000]
assert len(samples) >= 0.97 * sensors["received"], (len(samples), sensors)
worst = max(int(r["end_ns"]) - int(r["release_ns"]) for r in samples)
assert abs(figures["response_ns"]["max"] - worst) <= 20_000_000, (figures["response_ns"], worst)
assert figures["deadline"]["missed"] == figures["deadline"]["judged"] > 0.97 * sensors["received"], figures
assert figures["command_age_ns"]["max"] > seconds / 6 * 1_000_000_000, figures
late = figures["late"]
assert late["others_ns"] == {} and late["queued_ns"] + late["executed_ns"] >= 0.99 * late["total_ns"], late
PY
done

# Others have the core: a planner of higher priority that computes for 40 ms of each 100.
cat >planner.py <<'PY'
import sys, time
def burn(seconds):
    until = time.thread_time() + seconds
    while time.thread_time() < until: pass
while True:
    burn(float(sys.argv[1]))
    time.sleep(float(sys.argv[2]))
PY
sed -i '/^    burn(0.015)$/d' controller.py
sed -i 's/^        body: drone$/&\n      planner: {command: [python3, planner.py, "0.04", "0.06"], priority: 90, start: 0.5s}/' scenario.yaml
said --duration 3s --out "$out/kept"
says 'hover/controller missed [0-9]* of [0-9]* of its deadlines (10 ms, the period of sensors), up to [0-9]* in a row, the first at 0\.[0-9]* s: hover/planner, of higher priority, had the core for \([89][0-9]\|100\) % of that time'
python3 - "$out/kept" <<'PY' || fail "the figures of a controller that others kept from its core"
import json, sys
figures = json.load(open(sys.argv[1] + "/summary.json"))["clients"]["hover/controller"]
late = figures["late"]
assert set(late["others_ns"]) == {"hover/planner"}, late
# While a program is executed anew, nobody is known to have the core.
assert 0.98 * late["total_ns"] <= late["queued_ns"] + late["executed_ns"] + sum(late["others_ns"].values()) <= late["total_ns"], late
assert 0.2 < figures["deadline"]["missed"] / figures["deadline"]["judged"] < 0.45, figures["deadline"]
PY

# All of it: the controller does not even begin.
said --set 'robots.hover.clients.planner.command=[python3, planner.py, "100", "0"]' \
  --set robots.hover.clients.planner.start=0s --duration 1300ms --out "$out/starved"
says 'hover/controller was starved: for 1\.\?[0-9]* s from 0\.[0-9]* s on it was ready, and hover/planner, of higher priority, had the core'

# A deadline of its own, by fixed priorities, too.
said --set robots.hover.clients.controller.deadline=1us --duration 1s --accounting fixed --out "$out/own"
says 'hover/controller missed all [0-9]* of its deadlines (1 us).*: it computes [0-9.]* us each time, longer than its deadline'

# Loops of 100 Hz, by sleeping until the next time and by a timer's descriptor, that compute for 4 ms and for 15 ms.
cat >loop.py <<'PY'
import ctypes, os, struct, sys, time
def burn(seconds):
    until = time.thread_time() + seconds
    while time.thread_time() < until: pass
libc = ctypes.CDLL(None)
begun = time.clock_gettime_ns(time.CLOCK_MONOTONIC)
if sys.argv[1] == "timer":
    fd = libc.timerfd_create(1, 0)
    libc.timerfd_settime(fd, 0, struct.pack("4q", 0, 10_000_000, 0, 10_000_000), None)
for i in range(1, 51):
    if sys.argv[1] == "timer": os.read(fd, 8)
    else: libc.clock_nanosleep(1, 1, struct.pack("2q", *divmod(begun + i * 10_000_000, 1_000_000_000)), None)
    burn(float(sys.argv[2]))
PY
cat >loop.yaml <<'YAML'
duration: 2s
robots: {r: {clients: {loop: {command: [python3, loop.py, WAY, "SECONDS"], class: periodic}}}}
YAML
for way in sleep timer; do
  sed "s/WAY/$way/; s/SECONDS/0.004/" loop.yaml >well.yaml
  # Under set costs: a measured one is late where the host takes its processor for 6 ms unseen.
  said well.yaml --accounting fixed --out "$out/loop"
  ! grep '^! ' "$out/said" || fail "$way: it kept up"
  says '10 ms *0 of [45][0-9]'
  sed "s/WAY/$way/; s/SECONDS/0.015/" loop.yaml >slow.yaml
  said slow.yaml --out "$out/loop"
  says '^! r/loop missed \(all [0-9]*\|4[0-9] of [0-9]*\) of its deadlines (10 ms, the period of its timer), .*: it computes 1[456][0-9.]* ms each time, 1[456][0-9] % of a core'
done

# What is sent to a port before anybody listens there was never in a socket: the first one that is read is no older.
cat >talk.py <<'PY'
import socket, sys, time
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
if sys.argv[1] == "sends":
    for _ in range(20):
        s.sendto(b"x", ("127.0.0.1", 27912))
        time.sleep(0.1)
else:
    time.sleep(1)
    s.bind(("127.0.0.1", 27912))
    while True: s.recv(10)
PY
cat >talk.yaml <<'YAML'
duration: 3s
robots: {r: {clients: {sends: {command: [python3, talk.py, sends]}, hears: {command: [python3, talk.py, hears]}}}}
YAML
said talk.yaml --accounting fixed --out "$out/talk"
python3 - "$out/talk" <<'PY' || fail "what nobody heard counts"
import json, sys
[input] = json.load(open(sys.argv[1] + "/summary.json"))["clients"]["r/hears"]["inputs"]
assert 5 <= input["received"] == input["sent"] <= 12 and input["unread"] == input["lost"] == 0, input
assert input["age_ns"]["max"] < 20_000_000, input
PY
