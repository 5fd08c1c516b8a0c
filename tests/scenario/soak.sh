#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# 200 clients of mixed kinds for 6 s of virtual time: nobody hangs, loses anything or leaves
# anything behind, the coordinator does not grow, and progress stays together. A third argument
# is for how many seconds instead.
# Topics: soak, clean-up, drift.
seconds=${3:-6}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
ln -s "$build/bin/soak_client" "$out"  # other tests have some, too
kinds=(periodic bursts threads births children stream datagrams signals descriptors)
# How many descriptors and threads the coordinator has, each tenth of a virtual second.
cat >"$out/watch.py" <<'PY'
import os, sys, time
parent = f"/proc/{os.getppid()}"
begin = time.monotonic()
for look in range(10 * int(sys.argv[1])):
    time.sleep(max(0, begin + look / 10 - time.monotonic()))
    print(len(os.listdir(parent + "/fd")), len(os.listdir(parent + "/task")))
PY
{
  echo "duration: $((seconds + 1))s"
  echo "robots:"
  client=0
  for robot in $(seq 10); do
    echo "  robot$robot:"
    echo "    cpu: {cores: $((robot % 3 + 1))}"
    echo "    clients:"
    for _ in $(seq 20); do
      kind=${kinds[client++ % ${#kinds[@]}]}
      echo "      $kind$client: {command: [$out/soak_client, $kind, \"$seconds\"], priority: $((client % 4))}"
    done
  done
  echo "  watcher: {clients: {watch: {command: [python3, watch.py, \"$seconds\"]}}}"
} >"$out/scenario.yaml"

"$tcsim" run "$out/scenario.yaml" --out "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
python3 - "$out" "$seconds" <<'PY'
import json, os, pathlib, sys
out, seconds = pathlib.Path(sys.argv[1]), int(sys.argv[2])
summary = json.loads((out / "run/summary.json").read_text())
assert (seconds - 0.1) * 1e9 <= summary["virtual_ns"] <= (seconds + 1) * 1e9, summary["virtual_ns"]
assert summary["drift_ns"] <= summary["drift_bound_ns"], summary["drift_ns"]
assert summary["staleness_ns"] == 0, summary["staleness_ns"]
assert len(summary["clients"]) == 201
for name, client in summary["clients"].items():
    log = out / ("run/%s.err.log" % name.replace("/", "-"))
    assert client["wait_status"] == 0 and client["ended_at_ns"] >= (seconds - 1) * 1e9, (name, client, log.read_text())
counts, threads = zip(*(map(int, line.split()) for line in (out / "run/watcher-watch.out.log").open()))
assert len(counts) == 10 * seconds and min(counts) > 200, counts
# Each client has a few while it lives, and for some a look comes just when a call has a few more; for more of them the longer
# they have run. So the lower quarter counts. What grows
# beyond the middle of the run is a leak: each kind has clients that do each second what may leave something.
middle, last = (sorted(part)[len(part) // 4] for part in (counts[len(counts) // 3 : len(counts) * 2 // 3], counts[len(counts) * 2 // 3 :]))
assert last <= middle + 10, counts
assert max(counts) <= middle + 400, counts
# Besides its own, one for each further processor of the host on which programs compute ahead.
assert max(threads) <= os.cpu_count(), threads
PY
[[ -z $(new_in_shm) ]] || fail "something is left in /dev/shm: $(new_in_shm)"
! pgrep -f "$out/soak_client" >/dev/null || fail "clients are left"
