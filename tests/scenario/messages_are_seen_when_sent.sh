#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Packets of 1 kHz reach a waiting thread of another robot when they are sent, though its processor is
# busy with another program, whatever the drift bound. The sender sleeps between them, so that this
# costs three dispatches for each under measured accounting: of the sender, of the receiver, of the
# busy program.
# Topics: scheduling, udp, threads.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
program="$build/bin/paced_datagrams"
packets=300
for work in "compute" "compute, look"; do
  cat >"$out/scenario.yaml" <<YAML
duration: 0.7s
robots:
  drone:
    clients:
      receiver: {command: ["$program", receive, "27496", "$packets"]}
      planner: {command: ["$program", $work]}
  ground:
    clients:
      sender: {command: ["$program", send, "27496", "1000", "$packets"]}
YAML
  for accounting in measured fixed; do
    for bound in 0.1ms 10ms; do
      "$tcsim" run "$out/scenario.yaml" --accounting "$accounting" --drift "$bound" \
        --out "$out/$accounting, $work, $bound" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
    done
  done
done
python3 - "$packets" "$out"/*,*,* <<'PY' || fail "$(cat "$out"/*,*,*/summary.json)"
import json, sys
packets = int(sys.argv[1])
for run in sys.argv[2:]:
    print(run)
    summary = json.load(open(run + "/summary.json"))
    times = [tuple(map(int, line.split())) for line in open(run + "/drone-receiver.out.log")]
    assert len(times) == packets, len(times)
    took = [received - sent for sent, received in times]
    intervals = [after[1] - before[1] for before, after in zip(times, times[1:])]
    assert summary["drift_ns"] <= summary["drift_bound_ns"], summary["drift_ns"]
    assert summary["staleness_ns"] == 0, summary["staleness_ns"]
    if "/fixed, " in run:
        # The call that sends and the one that looks at the clock afterwards, to the nanosecond.
        assert set(took) == {2000}, (min(took), max(took))
        assert set(intervals) == {1_000_000}, (min(intervals), max(intervals))
        assert summary["lateness_ns"] == 0, summary["lateness_ns"]
    else:
        # What the programs compute themselves between their two readings comes on top.
        middle = sorted(took)[len(took) // 2]
        assert 0 <= min(took) and middle <= 150_000, (min(took), middle)
        # The host stops a thread late once in some thousand times.
        assert sorted(took)[len(took) * 9 // 10] <= 300_000, sorted(took)[-40:]
        assert summary["lateness_ns"] <= 2_000_000, summary["lateness_ns"]
        even = sorted(intervals)[len(intervals) // 20:-len(intervals) // 20]
        assert 700_000 < even[0] and even[-1] < 1_300_000, (even[0], even[-1])
        assert summary["dispatches"] <= 3.3 * packets + 200, summary["dispatches"]
PY
