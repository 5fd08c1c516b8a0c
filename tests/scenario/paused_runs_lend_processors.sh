#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A run that is paused gives its processor to others, and has to wait for it if they have it when it is let go on; what
# it comes to is the same. One that is stopped while it waits ends.
# Topics: live page, host processors.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chrt -f 14 true 2>/dev/null || exit 77  # without real-time priorities runs wait for nothing
cat >"$out/s.yaml" <<'YAML'
duration: 1s
dynamics: {gravity: [0, 0, -9.81]}
bodies: {ball: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
robots: {r: {clients: {c: {command: [sleep, "0.5"]}}}}
YAML
"$tcsim" run "$out/s.yaml" --accounting fixed --out "$out/plain" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
cd "$(dirname -- "${BASH_SOURCE[0]}")"
timeout 450 python3 -B - "$tcsim" "$out" <<'PY' || fail "a paused run keeps its processor, or does not get it back"
import filecmp, os, signal, subprocess, sys
from live import LiveRun
tcsim, out = sys.argv[1:]
cpus = {max(os.sched_getaffinity(0))}
os.sched_setaffinity(0, cpus)  # all runs have one processor to claim
waits = "the run was paused, and goes on when it has its processor again"

def holder():
    """A run that has the processor until it is let go."""
    process = subprocess.Popen([tcsim, "exec", "--", "sh", "-c", "echo has it; read line"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, text=True)
    assert process.stdout.readline() == "has it\n"  # only once the paused one has given it
    return process

with LiveRun(tcsim, f"{out}/s.yaml", f"{out}/paused", "--pause") as run:
    run.stands_at(0)
    run.control("step 300000000")
    run.stands_at(300_000_000)
    other = holder()
    run.tell("go")
    run.until(lambda: waits in run.words())
    assert run.status()["now"] < 400_000_000, ("it goes on without its processor", run.status())
    other.communicate("\n", timeout=180)
    assert "interrupted" not in run.end()
for file in "bodies.csv", "activations.csv", "dispatches.csv":
    assert filecmp.cmp(f"{out}/plain/{file}", f"{out}/paused/{file}", shallow=False), file

with LiveRun(tcsim, f"{out}/s.yaml", f"{out}/stopped", "--pause") as run:
    run.stands_at(0)
    other = holder()
    run.tell("go")
    run.until(lambda: waits in run.words())
    run.process.send_signal(signal.SIGTERM)
    run.end(128 + signal.SIGTERM)
    other.communicate("\n", timeout=100)
PY
[[ -z $(new_in_shm) ]] || fail "left in /dev/shm: $(new_in_shm)"
