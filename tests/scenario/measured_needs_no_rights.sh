#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/as_nobody.sh"
# Who may not have a real-time priority runs the example under both accountings. Fixed, what is written is the
# same to the byte. Measured, drift and staleness keep their bounds, charges agree with the threads' own CPU
# clocks, and known work costs the same with and without calls, beside others and alone.
# The example's two flights are the same where Docker's default profile refuses pidfd_getfd besides.
# Topics: rights, accounting, drift, containers.
((EUID == 0)) || exit 77  # to have both
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chmod 755 "$out"
install_for_everybody "$build" "$out" steady_worker in_container_profile
cp -r "$build/examples/predator_prey" "$out/example"
chmod -R a+rX "$out/example"
mkdir -m 777 "$out/with" "$out/without" "$out/contained"
cat >"$out/work.yaml" <<END
duration: 60s
robots:
  alone: {clients: {long: {command: [$out/bin/steady_worker, long, "300"]}}}  # as long as both others
  shared:
    clients:
      long: {command: [$out/bin/steady_worker, long, "100"]}
      short: {command: [$out/bin/steady_worker, short, "4000"], priority: 10}
END

# Computes for 0.1 ms of its own time, sleeps as long, and so on: half of a processor, of any host.
cat >"$out/urgent.py" <<'PY'
import time
for _ in range(4000):
    until = time.thread_time() + 1e-4
    while time.thread_time() < until: pass
    time.sleep(1e-4)
PY
# Who is deaf to the signal that stops threads computes on, and owes what it computes.
cat >"$out/deaf.py" <<'PY'
import ctypes, sys, time
if sys.argv[1] == "deaf":
    every = ctypes.c_uint64(2**64 - 1)
    assert ctypes.CDLL(None).syscall(14, 0, ctypes.byref(every), None, 8) == 0  # rt_sigprocmask, raw
# For 0.3 s on any host, without a look at the clock between.
def compute(loops):
    begun = time.thread_time(), time.monotonic()
    for _ in range(loops): pass
    return time.thread_time() - begun[0], time.monotonic() - begun[1]
took = 0
loops = 100_000
while took < 0.02: loops *= 2; took = compute(loops)[0]
print(*compute(int(loops * 0.3 / took)))
PY
cat >"$out/deaf.yaml" <<END
duration: 60s
robots:
  robot:
    clients:
      deaf: {command: [python3, $out/deaf.py, deaf]}
      urgent: {command: [python3, $out/urgent.py], priority: 10}
  other: {clients: {hears: {command: [python3, $out/deaf.py, hears]}}}
END

run() {  # with|without|contained NAME SCENARIO ARGUMENTS...: into FOLDER/NAME
  local folder=$out/$1 name=$2 scenario=$3 as=()
  shift 3
  [[ $folder == */with ]] || as=("${nobody[@]}")
  [[ $folder != */contained ]] || as+=("$out/bin/in_container_profile")
  env -i PATH="$PATH" HOME=/ timeout 200 "$build/bin/in_own_network" "${as[@]}" "$out/bin/tcsim" run "$scenario" "$@" \
    --out "$folder/$name" >"$folder/$name.said" 2>&1 || fail "$(cat "$folder/$name.said")"
}
for rights in with without contained; do
  run $rights fixed "$out/example/scenario.yaml" --duration 1.2s --accounting fixed
  run $rights flight "$out/example/scenario.yaml" --duration 1.2s
done
run without deaf "$out/deaf.yaml"
for rights in with without; do run $rights pieces "$out/work.yaml" --host-cpus 1; done
! grep -q 'SCHED_FIFO is not permitted here' "$out/with/flight.said" || exit 77
for said in "$out"/{without,contained}/*.said; do
  grep -q 'SCHED_FIFO is not permitted here' "$said" || fail "it ran with rights: $said"
done
for said in "$out"/contained/*.said; do
  grep -q 'pidfd_getfd is refused here' "$said" || fail "it was not refused: $said"
done
for file in bodies.csv dispatches.csv activations.csv trace.json; do
  [[ -s $out/with/fixed/$file ]] || fail "no $file"
  for less in without contained; do
    cmp "$out/with/fixed/$file" "$out/$less/fixed/$file" || fail "$file depends on rights: $less"
  done
done
python3 - "$out" <<'PY' || fail "$(cat "$out"/*/*.said)"
import json, sys
folder = sys.argv[1]
def summary(rights, name): return json.load(open(f"{folder}/{rights}/{name}/summary.json"))
def check(s):
    assert s["staleness_ns"] == 0, s
    assert s["drift_ns"] <= 1_000_000, s
    for name, c in s["clients"].items():
        assert abs(c["charged_ns"] - c["priced_ns"] - c["host_cpu_ns"]) <= 0.01 * c["host_cpu_ns"] + 200_000, (name, c)
# How much a controller gets done in that time is a matter of the host.
for rights in ("with", "without", "contained"):
    s = summary(rights, "flight")
    check(s)
    assert 0 < s["drift_ns"] and s["commands"] > 0, s
deaf = summary("without", "deaf")
check(deaf)
assert deaf["drift_ns"] > 0 and deaf["clients"]["robot/urgent"]["charged_ns"] > 100_000_000, deaf
took = {log: tuple(map(float, open(f"{folder}/without/deaf/{log}.out.log").read().split()))
        for log in ("robot-deaf", "other-hears")}
print("charged and passed", took)
for log, (charged, passed) in took.items():
    assert charged > 0.1, (log, charged)
# One has its processor for itself; the other one waits for the urgent one, which takes about half of it.
assert took["other-hears"][1] < 1.02 * took["other-hears"][0], took
assert took["robot-deaf"][1] > 1.2 * took["robot-deaf"][0], took
# What the same work costs depends on what the host does meanwhile: a neighbour may have half of the core for seconds. So
# pieces are compared with those that were computed while they were, a millisecond here and a millisecond there. A short
# one is 0.03 of a long one.
def pieces(rights, log):
    words = list(map(float, open(f"{folder}/{rights}/pieces/{log}.out.log").read().splitlines()[2].split()))
    return list(zip(words[::2], words[1::2]))
def ratio(those, to, share):
    ends = [begun for begun, _ in to[1:]]
    ratios = []
    for (begun, cost), end in zip(to, ends):
        meanwhile = [c for b, c in those if begun <= b + c / 2 < end]
        if meanwhile: ratios.append(sum(meanwhile) / len(meanwhile) / cost / share)
    assert len(ratios) > 20, (rights, len(ratios), those[0], those[-1], to[0], to[-1])
    return sorted(ratios)[len(ratios) // 2]
for rights in ("with", "without"):
    check(summary(rights, "pieces"))
    alone, beside, short = (pieces(rights, log) for log in ("alone-long", "shared-long", "shared-short"))
    beside_alone, shorter = ratio(alone, beside, 1), ratio(short, alone, 0.03)
    print(rights, "rights: alone a piece costs", beside_alone, "of what it costs beside others; short ones of what it costs alone", shorter)
    # A long piece is stopped for a short one some thirty times, and pays for each what a switch takes, 12 us on an idle host.
    assert 0.7 < beside_alone < 1.15, (rights, beside_alone)
    assert abs(shorter - 1) < 0.25, (rights, shorter)
PY
