#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Who lives at the run's end gets a signal, and virtual time to write what it has and to exit; who
# does not is killed. The run itself, and what it says of itself, ends where it was to end.
# Topics: ends, signals.
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT

# Its stdout is a file, so what it prints stays with it until it ends in order.
cat >"$out/keeper.py" <<'PY'
import signal, sys, time
def now(): return time.clock_gettime(time.CLOCK_MONOTONIC) - 1000
wanted, takes = getattr(signal, sys.argv[1]), float(sys.argv[2])
def end(number, frame):
    print("signal %d at %.3f" % (number, now()))
    time.sleep(takes)
    print("over at %.3f" % now())
    sys.exit(3)
signal.signal(wanted, end)
print("begun")
while True: time.sleep(0.01)
PY
cat >"$out/stdio.c" <<'C'
#include <signal.h>
#include <stdio.h>
#include <unistd.h>
static volatile sig_atomic_t over;
static void End(int number) { over = number; }
int main(void) {
  signal(SIGTERM, End);
  printf("begun\n");
  while (!over) pause();
  printf("ended by %d\n", (int)over);
}
C
cc -O1 -o "$out/stdio" "$out/stdio.c"
cat >"$out/s.yaml" <<YAML
duration: 2s
robots:
  r:
    clients:
      keeper: {command: [python3, keeper.py, SIGTERM, "0.3"]}
      interrupted: {command: [python3, keeper.py, SIGINT, "1.2"], stop_signal: SIGINT, stop_grace: 1.5s}
      stdio: {command: [./stdio]}
      shell: {command: [bash, -c, "trap 'echo bye; exit 7' TERM; while :; do sleep 0.05; done"]}
      default: {command: [python3, -c, "import time; time.sleep(99)"]}
      child: {command: [sh, -c, "python3 keeper.py SIGTERM 0.1; true"]}
  late:
    clients:
      too_slow: {command: [python3, -u, keeper.py, SIGTERM, "0.9"]}
      short: {command: [python3, -u, keeper.py, SIGTERM, "0.2"], stop_grace: 100ms}
      none: {command: [python3, -u, keeper.py, SIGTERM, "0"], stop_grace: 0}
      stopped: {command: [python3, -u, -c, "import os, signal, sys\nsignal.signal(15, lambda n, f: print('woken') or sys.exit(0))\nos.kill(os.getpid(), signal.SIGSTOP)\nsignal.pause()"]}
YAML

# Who computes on and ignores the signal is killed, too: after so much virtual time, or where
# computing takes none, real time: as much as the run's patience.
cat >"$out/spin.yaml" <<'YAML'
duration: 500ms
dynamics: {}
bodies: {b: {mass: 1, inertia: [1, 1, 1]}}
robots:
  r:
    cpu: {cores: 2}
    clients:
      spinner: {command: [bash, -c, "trap '' TERM; while :; do :; done"]}
      child: {command: [bash, -c, "trap '' TERM; (while :; do :; done) & wait; wait"]}
YAML
spinners_are_killed() {
  timeout 200 "$tcsim" run "$out/spin.yaml" --set robots.r.clients.child=null --duration 200ms \
    --set 'robots.r.clients.spinner.command=[python3, -c, "import signal\nsignal.signal(15, signal.SIG_IGN)\nwhile True: pass"]' \
    --accounting fixed --patience 1s --out "$out/spin" >"$out/spin.said" 2>&1 || fail "fixed: status $?: $(cat "$out/spin.said")"
  grep -q 'r/spinner was killed: after SIGTERM' "$out/spin.said" || fail "fixed: $(cat "$out/spin.said")"
  timeout 200 "$tcsim" run "$out/spin.yaml" --out "$out/spin" >"$out/spin.said" 2>&1 || fail "status $?: $(cat "$out/spin.said")"
  grep -q 'r/spinner was killed: after SIGTERM' "$out/spin.said" || fail "$(cat "$out/spin.said")"
}
beside spinners_are_killed

# Whom the kernel has in its hands, here for a lock that somebody outside holds, gets the grace in real time, too: by virtual
# time, which goes on with the other thread, it would be over in a moment.
cat >"$out/held.py" <<'PY'
import fcntl, signal, sys, threading, time
lock = open(sys.argv[1])
def end(number, frame):
    print("asks", flush=True)
    fcntl.flock(lock, fcntl.LOCK_EX)
    print("has it", flush=True)
    sys.exit()
def tick():
    while True: time.sleep(0.01)
signal.signal(signal.SIGTERM, end)
threading.Thread(target=tick, daemon=True).start()
tick()
PY
cat >"$out/held.yaml" <<YAML
duration: 2s
robots: {r: {clients: {held: {command: [python3, held.py, "$out/lock"], stop_grace: 30s}}}}
YAML
the_held_are_awaited() {
  local run
  exec {lock}>"$out/lock"
  flock "$lock"
  timeout 200 "$tcsim" run "$out/held.yaml" --out "$out/held" >"$out/held.said" 2>&1 {lock}>&- &
  run=$!
  for _ in $(seq 2000); do
    grep -qs asks "$out/held/r-held.out.log" && break
    sleep 0.05
  done
  sleep 1
  exec {lock}>&-
  wait "$run" || fail "$(cat "$out/held.said")"
  grep -q 'has it' "$out/held/r-held.out.log" || fail "was not waited for: $(cat "$out/held.said")"
}
beside the_held_are_awaited

said_by() { cat "$out/run/$1.out.log"; }
check() {
  local accounting=$1 status=0
  timeout 200 "$tcsim" run "$out/s.yaml" --accounting "$accounting" --out "$out/run" \
    >"$out/said" 2>&1 || status=$?
  ((status == 0)) || fail "$accounting: status $status: $(cat "$out/said")"
  python3 - "$out/run" "$accounting" <<'PY' || fail "$accounting: $(tail -n 99 "$out/said" "$out"/run/*.log)"
import json, re, sys
folder, accounting = sys.argv[1:]
summary = json.load(open(folder + "/summary.json"))
assert summary["virtual_ns"] == 2_000_000_000, summary["virtual_ns"]
for name, client in summary["clients"].items():
    assert (client["ended_at_ns"], client["wait_status"]) == (-1, 0), (name, client)
    assert client["charged_ns"] < 2_000_000_000, (name, client)
def said(name): return open(folder + "/" + name + ".out.log").read()
def handled(name, number, takes):  # the handler runs at the run's end, and is not cut off
    begun, signal, over = said(name).splitlines()
    at = float(re.fullmatch("signal %d at (.*)" % number, signal)[1])
    # They all have one core, and what a handler of Python's or a shell costs once is the host's.
    soon = 0.05 if accounting == "fixed" else 0.25
    assert 2.0 <= at < 2 + soon, signal
    until = float(re.fullmatch("over at (.*)", over)[1])
    assert at + takes - 0.0015 <= until < at + takes + soon, (signal, over)
handled("r-keeper", 15, 0.3)
handled("r-interrupted", 2, 1.2)
handled("r-child", 15, 0.1)  # all its processes get it
assert said("r-stdio") == "begun\nended by 15\n", said("r-stdio")
assert said("r-shell") == "bye\n", said("r-shell")
assert said("late-stopped") == "woken\n", said("late-stopped")
for name in "late-too_slow", "late-short":
    assert said(name).startswith("begun\nsignal 15 at 2.") and "over" not in said(name), said(name)
assert said("late-none") == "begun\n", said("late-none")
killed = sorted(w.split()[0] for w in summary["warnings"] if "was killed" in w)
assert killed == ["late/short", "late/too_slow"], summary["warnings"]
PY
}
check measured
check fixed

# What clients do in their grace is no part of the run: it is the same without any.
cat >"$out/world.yaml" <<'YAML'
duration: 1s
dynamics: {}
bodies: {b: {mass: 1, inertia: [1, 1, 1], linear_velocity: [1, 0, 0]}}
robots:
  r:
    clients:
      keeper: {command: [bash, -c, "trap 'sleep 0.4; echo bye; exit' TERM; while :; do sleep 0.05; done"]}
      stdio: {command: [./stdio]}
YAML
timeout 200 "$tcsim" run "$out/world.yaml" --accounting fixed --out "$out/with" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
timeout 200 "$tcsim" run "$out/world.yaml" --accounting fixed --out "$out/without" --set robots.r.clients.keeper.stop_grace=0 \
  --set robots.r.clients.stdio.stop_signal=KILL >"$out/said" 2>&1 || fail "$(cat "$out/said")"
for file in bodies.csv activations.csv dispatches.csv trace.json; do
  cmp "$out/with/$file" "$out/without/$file" || fail "the grace changes $file"
done
[[ $(cat "$out/with/r-keeper.out.log" "$out/with/r-stdio.out.log") == $'bye\nbegun\nended by 15' ]] || fail "no grace"
[[ -z $(cat "$out/without/"*.out.log) ]] || fail "a grace of 0 is none"

all_done
none_left "$out/" || fail "something is left: $(pgrep -af "$out/")"
