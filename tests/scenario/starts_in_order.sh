#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Programs start when their scenario says, at a virtual time or after another one, and in the folders
# that it names: those of a run's own are fresh in each run and each trial.
# Topics: scenario files, processes, trials.
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT

mkdir -p "$out/scenarios/maps/deep"
cat >"$out/scenarios/note.py" <<'PY'
import os, sys, time
def now(): return time.clock_gettime(time.CLOCK_MONOTONIC) - 1000
print("%.3f" % now(), os.getcwd(), ",".join(sorted(os.listdir())))
open("by-" + sys.argv[1], "w").write(sys.argv[1])
time.sleep(float(sys.argv[2]))
print("%.3f" % now())
sys.exit(int(sys.argv[3]))
PY
echo hill >"$out/scenarios/maps/deep/hill"
printf '#!/bin/sh\necho tool\n' >"$out/scenarios/maps/tool"
chmod +x "$out/scenarios/maps/tool"
ln -s deep/hill "$out/scenarios/maps/link"
cat >"$out/scenarios/s.yaml" <<'YAML'
duration: 5s
robots:
  r:
    clients:
      # As it is written: whom it waits for comes later in the file, and on another computer.
      last: {command: [python3, "${scenario_dir}/note.py", last, "0", "0"], after: second, start: 3s, working_directory: "${result_dir}/shared/deep"}
      busy: {command: [sleep, infinity]}
      soon: {command: [python3, "${scenario_dir}/note.py", soon, "0", "0"], after: q/second, priority: 5, working_directory: {fresh: true}}
      never: {command: [python3, "${scenario_dir}/note.py", never, "0", "0"], after: busy}
  q:
    clients:
      first: {command: [python3, "${scenario_dir}/note.py", first, "0.5", "3"], start: 1s, working_directory: {copy_of: maps}}
      second: {command: [python3, "${scenario_dir}/note.py", second, "0.25", "0"], after: first, working_directory: {fresh: true}}
YAML

check() {  # FOLDER MORE_OPTIONS...
  local folder=$1 status=0
  shift
  (cd "$out" && timeout 150 "$tcsim" run scenarios/s.yaml --out "$folder" "$@") >"$out/$folder.said" 2>&1 || status=$?
  # The first one has failed, and those after it have been started all the same.
  ((status == 1)) || fail "$*: status $status: $(cat "$out/$folder.said")"
  grep -q '^tcsim: q/first ended at 1.* with exit status 3' "$out/$folder.said" || fail "$(cat "$out/$folder.said")"
  python3 - "$out/$folder" <<'PY' || fail "$*: $(tail -n 99 "$out/$folder.said" "$out/$folder"/*.log)"
import json, os, sys
folder = sys.argv[1]
summary = json.load(open(folder + "/summary.json"))
assert summary["virtual_ns"] == 5_000_000_000, summary["virtual_ns"]
def of(name):
    begin, end = open(folder + "/" + name + ".out.log").read().splitlines()
    at, where, found = (begin + " ").split(" ")[:3]
    client = summary["clients"][name.replace("-", "/")]
    # Python takes a moment to start.
    assert client["started_at_ns"] / 1e9 <= float(at) < client["started_at_ns"] / 1e9 + 1, (name, client, begin)
    assert abs(client["ended_at_ns"] / 1e9 - float(end)) < 0.5, (name, client, end)
    return client["started_at_ns"], client["ended_at_ns"], where, found
first = of("q-first")
assert first[0] == 1_000_000_000, first
assert first[2:] == (folder + "/q-first", "deep,link,tool"), first
assert open(folder + "/q-first/link").read() == "hill\n" and os.path.islink(folder + "/q-first/link")
assert os.access(folder + "/q-first/tool", os.X_OK)
second = of("q-second")
assert first[1] <= second[0] <= first[1] + 1_000_000, (first, second)
assert second[2:] == (folder + "/q-second", ""), second
soon = of("r-soon")  # beside one that computes on
assert second[1] <= soon[0] <= second[1] + 1_000_000, (second, soon)
last = of("r-last")
assert 3_000_000_000 <= last[0] <= 3_001_000_000, last
assert last[2] == folder + "/shared/deep", last
never = summary["clients"]["r/never"]
assert (never["started_at_ns"], never["ended_at_ns"], never["charged_ns"]) == (-1, -1, 0), never
assert not os.path.exists(folder + "/r-never.out.log")
assert [w for w in summary["warnings"] if "r/never was never started, because it starts after r/busy" in w]
PY
  [[ -e $out/scenarios/maps/by-first ]] && fail "the copied folder was written to"
  true
}
# Computes for all of the run, beside the others.
check busy --set 'robots.r.clients.busy.command=[sh, -c, "while :; do :; done"]' &
busy=$!
check run --accounting fixed
touch "$out/run/r-never.out.log" "$out/run/q-second/left"
check run --accounting fixed

# A client that starts when all others have ended is waited for; with a world, too.
for world in "" $'dynamics: {}\nbodies: {b: {mass: 1, inertia: [1, 1, 1]}}'; do
  printf '%s\n' 'duration: 100s' "$world" 'robots: {r: {clients: {a: {command: [date, +%s], start: 70s}, b: {command: ["true"]}}}}' >"$out/late.yaml"
  timeout 150 "$tcsim" run "$out/late.yaml" --accounting fixed --out "$out/late" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  [[ $(cat "$out/late/r-a.out.log") == $((1704067200 + 70)) ]] || fail "it saw $(cat "$out/late/r-a.out.log")"
  grep -q 'ended before its 100.000 s because all programs had ended' "$out/said" || fail "$(cat "$out/said")"
done

# Each trial has folders of its own.
sed 's/"3"\], start/"0"], start/' "$out/scenarios/s.yaml" >"$out/scenarios/well.yaml"
timeout 150 "$tcsim" trials "$out/scenarios/well.yaml" --trials 2 --accounting fixed --out "$out/trials" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
for seed in 1 2; do
  grep -q " $out/trials/seed-000$seed/q-first deep,link,tool" "$out/trials/seed-000$seed/q-first.out.log" || fail "$(cat "$out/trials/seed-000$seed/q-first.out.log")"
  [[ -e $out/trials/seed-000$seed/q-second/by-second ]] || fail "trial $seed has no folder"
done

# A folder that goes before its client starts is named by its last words.
printf '%s\n' 'duration: 9s' 'robots: {r: {clients: {a: {command: [rmdir, gone]}, b: {command: ["true"], start: 1s, working_directory: gone}}}}' >"$out/gone.yaml"
mkdir "$out/gone"
status=0
timeout 150 "$tcsim" run "$out/gone.yaml" --out "$out/run" >"$out/said" 2>&1 || status=$?
((status == 1)) || fail "status $status: $(cat "$out/said")"
grep -q "^tcsim: r/b ended at 1.* exit status 127: .*the working directory $out/gone cannot be entered: No such file" "$out/said" || fail "$(cat "$out/said")"
wait "$busy"
