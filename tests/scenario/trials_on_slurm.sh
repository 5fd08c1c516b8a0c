#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$(dirname -- "${BASH_SOURCE[0]}")/slurm_world.sh"
source "$(dirname -- "${BASH_SOURCE[0]}")/trials_world.sh"
# A grid over a cluster of four nodes, one of which is killed in the middle of a trial: each trial has one result, the
# lost one is named and run again, and all results are those of the same sweep on this machine, to the byte.
# TCS_SLURM_TRIALS: how many trials. With the argument `unaided` nobody tells Slurm that the node is dead.
# Topics: trials, slurm, determinism.
trap 'end_slurm; pkill -9 -f "$mark|$out"; rm -rf "$out"' EXIT
many=$((${TCS_SLURM_TRIALS:-16} / 2))
trials=("$tcsim" trials "$out/scenario.yaml" --accounting fixed --trials "$many" --vary duration=3s,3100ms --vary csv_period=10ms)
missed=60
[[ ${3:-} != unaided ]] || missed=5
start_slurm 4 $missed
timeout 400 "${trials[@]}" --out "$out/local" >"$out/said" 2>&1 || fail "$(cat "$out/said")"

# Until n2 is caught at work it has the sweep for itself, so that the others cannot be through before.
scontrol update NodeName=n[1,3-4] State=DRAIN Reason=later
SECONDS=0
timeout 400 "${trials[@]}" --out "$out/there" --launcher slurm --slurm-option=--partition=work >"$out/said" 2>&1 &
call=$!
results() { find "$out/there" -path "$out/there/slurm" -prune -o -name summary.json -print 2>/dev/null | wc -l; }
# The index of the trial that a run on n2 has begun, and not ended.
at_work() {
  local run
  for run in $(find "$out/there/slurm" -lname '*@n2' -printf '%h/../runs/%f.%l\n' 2>/dev/null); do
    run=${run%@n2}
    # The last look: results are fetched from there at any time.
    if [[ -e $run/bodies.csv && ! -e $run/summary.json && -e $run/bodies.csv ]]; then basename "${run%.*}"; fi
  done
}
# Trials last a quarter of a second.
be_on_time
for _ in $(seq 2400); do (($(results))) && break; sleep 0.05; done
# A job that is stopped cannot hand in what it has run; and with all that it has started it cannot run it to its end, either.
signal_jobs() {  # SIGNAL PROCESS...: the processes, and then all that they have started
  local signal=$1
  shift
  kill "-$signal" "$@" 2>/dev/null || return
  # shellcheck disable=SC2046
  kill "-$signal" $(with_descendants "$@") 2>/dev/null || true
}
jobs="" lost=""
for _ in $(seq 2000); do
  [[ -e /proc/$call ]] || break
  [[ -n $jobs ]] || jobs=$(jobs_of n2)
  # shellcheck disable=SC2086
  if [[ -n $jobs ]] && signal_jobs STOP $jobs; then
    lost=$(at_work)
    [[ -z $lost ]] || break
    signal_jobs CONT $jobs || jobs=""
  else
    jobs=""
  fi
  sleep 0.02
done
[[ -n $lost ]] || fail "n2 runs nothing: $(cat "$out/said")"
kill_node n2
be_ordinary
scontrol update NodeName=n[1,3-4] State=RESUME
# Slurm would find out by itself, after some 15 s; the job ends alike when an administrator knows it before.
[[ ${3:-} == unaided ]] || scontrol update NodeName=n2 State=DOWN Reason=killed
killed_at=$SECONDS
status=0; wait "$call" || status=$?
echo "$((2 * many)) trials in $SECONDS s; $((SECONDS - killed_at)) of them since the node was killed"
((status == 0)) || fail "exit status $status: $(cat "$out/said")"

# Trial I has the seed 1 + I / 2, and the first value or the second one in turn.
value=(3s 3100ms)
named="seed $((1 + lost / 2)) with duration=${value[lost % 2]} csv_period=10ms"
grep -q "^tcsim: $named was lost on node n2 (.*); it is run again" "$out/said" || fail "$named: $(cat "$out/said")"
# Where a busy machine makes another node seem dead, its trials are lost as well, and treated alike.
grep 'was lost' "$out/said" | grep -Evq "^tcsim: seed [0-9]+ with duration=[0-9]+m?s csv_period=10ms was lost on node n[1-4] \(" &&
  fail "$(cat "$out/said")"
(($(results) == 2 * many)) || fail "$(results) results"
[[ ! -e $out/there/slurm ]] || fail "the jobs' folder is still there: $(find "$out/there/slurm")"
for duration in "${value[@]}"; do
  grep -Eq "^duration=$duration csv_period=10ms +$many of $many" "$out/said" || fail "$(cat "$out/said")"
  for seed in $(seq "$many"); do
    (($(grep -c "^seed $seed with duration=$duration csv_period=10ms: done" "$out/said") == 1)) || fail "seed $seed: $(cat "$out/said")"
    printf -v folder '%s,10ms/seed-%04d' "$duration" "$seed"
    same "$out/there/$folder" "$out/local/$folder"
    # As of a run in that folder: nothing tells of the one that it was written in.
    grep -rIl "$out/there/slurm" "$out/there/$folder" && fail "a path that is no more"
  done
done
nodes() { cat "$out"/there/*/*/job.json | grep -o '"node": "n[1-4]"'; }
nodes | sort | uniq -c
(($(nodes | sort -u | wc -l) >= 3)) || fail "not all nodes were used"
printf -v folder '%s,10ms/seed-%04d' "${value[lost % 2]}" $((1 + lost / 2))
grep -q '"node": "n2"' "$out/there/$folder/job.json" && fail "the dead node has handed in the trial that it lost"
# One of a dead node's takes longer to go.
tenths=600 no_jobs
