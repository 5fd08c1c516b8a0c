#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# 100 clients, whose children come and go, a hundred of each in an hour of virtual time: the
# coordinator's memory and descriptors do not grow. A third argument is how many seconds of it,
# instead of twenty minutes: 3600 are the hour, and 10,000 children.
# Topics: soak, processes.
seconds=${3:-1200}
out=$(mktemp -d)
watch=''
trap 'kill "$watch" 2>/dev/null || true; rm -rf "$out"' EXIT
# The coordinator's memory and descriptors, twenty times a second.
cat >"$out/watch.py" <<'PY'
import os, sys, time
def child_of(process): return open(f"/proc/{process}/task/{process}/children").read().split()[0]
while True:
    try:
        coordinator = child_of(child_of(sys.argv[1]))
        memory, = (line.split()[1] for line in open(f"/proc/{coordinator}/status") if line.startswith("VmRSS:"))
        print(memory, len(os.listdir(f"/proc/{coordinator}/fd")), flush=True)
    except (OSError, IndexError, ValueError): pass  # it is not there yet, or no more
    time.sleep(0.05)
PY
{
  echo "duration: $((seconds + 60))s"
  echo "robots:"
  for robot in $(seq 10); do
    echo "  robot$robot:"
    echo "    clients:"
    for client in $(seq 10); do
      echo "      c$client: {command: [$build/bin/soak_client, offspring, \"$seconds\"]}"
    done
  done
} >"$out/scenario.yaml"
"$tcsim" run "$out/scenario.yaml" --accounting fixed --out "$out/run" >"$out/said" 2>&1 &
run=$!
# A third of the looks are from the first third of the run only if it looks as often while the run has the processors.
on_time python3 "$out/watch.py" "$run" >"$out/sizes" &
watch=$!
wait "$run" || fail "$(cat "$out/said")"
kill "$watch"
wait "$watch" || true
python3 - "$out" "$seconds" <<'PY'
import json, pathlib, sys
out, seconds = pathlib.Path(sys.argv[1]), int(sys.argv[2])
summary = json.loads((out / "run/summary.json").read_text())
for name, client in summary["clients"].items():
    log = out / ("run/%s.err.log" % name.replace("/", "-"))
    assert client["wait_status"] == 0 and client["ended_at_ns"] >= seconds * 10**9, (name, client, log.read_text())
rows = [line.split() for line in (out / "sizes").read_text().splitlines()]
# From when its clients are there: before that it may wait for a processor.
sizes = [(int(row[0]), int(row[1])) for row in rows if len(row) == 2 and int(row[1]) > 100]
assert len(sizes) >= 3, rows
middle = len(sizes) // 3
memory, fds = zip(*sizes)
children = 100 * seconds // 36
print(f"{children} children; memory {memory[middle]} kB after a third, {max(memory)} kB at most; "
      f"descriptors {max(fds[:middle])} at most in the first third, {max(fds[middle:])} later")
# What is noted for the trace and the logs comes and goes.
assert max(memory[middle:]) <= memory[middle] + 4096, memory
assert max(fds[middle:]) <= max(fds[:middle]) + 40, fds
PY
