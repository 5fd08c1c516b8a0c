#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# 100 clients, whose children come and go, a hundred of each in an hour of virtual time: the
# coordinator's memory and descriptors do not grow. A third argument is how many seconds of it,
# instead of twenty minutes: 3600 are the hour, and 10,000 children.
# Topics: soak, processes.
seconds=${3:-1200}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
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
while kill -0 "$run" 2>/dev/null; do
  coordinator=$(coordinator_of "$run" 2>/dev/null | head -1 || true)
  if [[ -n $coordinator ]]; then
    echo "$(sed -n 's/^VmRSS:[[:space:]]*\([0-9]*\) kB/\1/p' "/proc/$coordinator/status" 2>/dev/null)" \
      "$(ls "/proc/$coordinator/fd" 2>/dev/null | wc -l)" >>"$out/sizes" || true
  fi
  sleep 0.05
done
wait "$run" || fail "$(cat "$out/said")"
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
