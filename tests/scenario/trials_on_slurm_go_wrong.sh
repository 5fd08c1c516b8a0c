#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$(dirname -- "${BASH_SOURCE[0]}")/slurm_world.sh"
source "$(dirname -- "${BASH_SOURCE[0]}")/trials_world.sh"
# What a cluster cannot do is said in one sentence; trials that fail are named, and trials whose jobs end are run again,
# but not for ever; ^C ends the jobs and leaves what is done, and the next call goes on.
# Topics: trials, slurm, failures, signals.
trap 'end_slurm; pkill -9 -f "$mark|$out"; rm -rf "$out"' EXIT
elsewhere=()
# Longer than a run of somebody else's may hold the processor for which a trial waits.
limit=200
trials() { timeout --foreground "$limit" "${elsewhere[@]}" "$tcsim" trials "$out/scenario.yaml" --accounting fixed --duration 400ms --launcher slurm "$@"; }
refused() {  # PATTERN OPTIONS...
  local pattern=$1 status=0
  shift
  trials --trials 2 "$@" >"$out/stdout" 2>"$out/stderr" || status=$?
  ((status == 2)) || fail "exit status $status instead of 2: $* $(cat "$out/stderr")"
  [[ $(wc -l <"$out/stderr") == 1 ]] || fail "not one line: $(cat "$out/stderr")"
  grep -Eq "^tcsim: .*$pattern" "$out/stderr" || fail "$(cat "$out/stderr")"
}
mkdir "$out/no_slurm"
elsewhere=(env "PATH=$out/no_slurm")
refused 'there is no sbatch in PATH; .*slurm-client' --out "$out/t"
elsewhere=()
[[ ! -e $out/t ]] || fail "the folder was made for nothing"

start_slurm 2
refused 'does not take the jobs: "Invalid partition name specified"; .*--slurm-option' --out "$out/t" \
  --slurm-option=--partition=nowhere
refused "'partition=x' is not an option of sbatch; write it like" --out "$out/t" --slurm-option=partition=x
refused '--array is set by tcsim; .*--jobs' --out "$out/t" --slurm-option=--array=1-9
refused 'no-wait is for trials on this machine' --out "$out/t" --no-wait
no_jobs

# A folder that only this machine sees, as root may make one.
mkdir "$out/hidden"
if unshare --mount true 2>/dev/null; then
  status=0
  timeout --foreground "$limit" unshare --mount bash -c 'mount -t tmpfs none "$0/hidden"; exec "$@"' "$out" "$tcsim" trials \
    "$out/scenario.yaml" --accounting fixed --launcher slurm --trials 4 --out "$out/hidden/t" \
    >"$out/stdout" 2>"$out/stderr" || status=$?
  ((status == 2)) || fail "exit status $status: $(cat "$out/stdout" "$out/stderr")"
  tail -n 1 "$out/stderr" | grep -Eq "^tcsim: node n[12] does not see the folder $out/hidden/t; choose one with --out" ||
    fail "$(cat "$out/stderr")"
  no_jobs
else
  echo "not shown, for want of rights to mount: a folder that nodes do not see"
fi

long() { timeout --foreground "$limit" "$tcsim" trials "$out/scenario.yaml" --accounting fixed --duration 1000h --launcher slurm "$@"; }
claim() { find "$out/$1/slurm" -path '*/claims/*' -printf '%l\n' 2>/dev/null | head -n 1 || true; }
begun() {  # FOLDER [JOB]: waits for a trial that another job has begun; that is `job` then
  for _ in $(seq 900); do
    job=$(claim "$1")
    [[ -n $job && $job != "${2:-}" ]] && return
    sleep 0.1
  done
  fail "no trial has begun: $(cat "$out/$1.said")"
}
# The job of one trial is cancelled each time that it begins. Most of that is waiting for Slurm: the next ones go on beside.
cancelled() {
  local call job="" status=0 said=$out/cancelled.said _
  long --trials 1 --out "$out/cancelled" >"$said" 2>&1 &
  call=$!
  for _ in 1 2 3; do
    begun cancelled "$job"
    scancel "${job%@*}"
  done
  wait "$call" || status=$?
  ((status == 1)) || fail "exit status $status: $(cat "$said")"
  (($(grep -c '^tcsim: seed 1 was lost on node n[12] (CANCELLED: .*); it is run again' "$said") == 2)) || fail "$(cat "$said")"
  grep -q '^tcsim: seed 1 failed: its job was lost 3 times, at last on node n[12] (CANCELLED: somebody has cancelled its job)$' \
    "$said" || fail "$(cat "$said")"
}
beside cancelled

# A trial that fails by itself is not run again.
status=0; FAILING_SEED=2 trials --trials 3 --out "$out/t" >"$out/said" 2>"$out/errors" || status=$?
((status == 1)) || fail "exit status $status: $(cat "$out/said" "$out/errors")"
grep -q "^tcsim: seed 2 failed: r/pilot ended at .* exit status 1: \"this seed is not for me\" ($out/t/seed-0002/r-pilot.err.log) ($out/t/seed-0002/tcsim.log)" \
  "$out/errors" || fail "$(cat "$out/errors")"
grep -q 'lost' "$out/errors" && fail "$(cat "$out/errors")"
grep -q 'not for me' "$out/t/seed-0002/r-pilot.err.log" || fail "its last words are lost"
trials --trials 3 --out "$out/t" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
grep -q '2 of 3 trials are done already' "$out/said" || fail "$(cat "$out/said")"

# As ^C does it: to all processes of the terminal.
set -m
"$tcsim" trials "$out/scenario.yaml" --accounting fixed --duration 400ms --launcher slurm --trials 10 --jobs 1 \
  --out "$out/resumed" >"$out/said" 2>&1 &
call=$!
# All of them are over soon after the first one, and Slurm may take longer to answer.
interrupt() {
  while [[ ! -e $out/resumed/seed-0001/summary.json && -e /proc/$call ]]; do sleep 0.05; done
  kill -INT -- "-$call"
}
be_on_time
interrupt &
interrupted=$!
for _ in $(seq 1200); do name=$(ls "$out/resumed/slurm" 2>/dev/null) && [[ -n $name ]] && break; sleep 0.05; done
be_ordinary
(($(squeue -h --array --name="$name" | wc -l) <= 1)) || fail "more than one job: $(squeue --array)"
wait "$interrupted" || fail "it has ended before: $(cat "$out/said")"
status=0; wait "$call" || status=$?
((status == 130)) || fail "exit status $status after ^C: $(cat "$out/said")"
grep -Eq 'interrupted; [0-9]+ of 10 trials are done, and the same call goes on' "$out/said" || fail "$(cat "$out/said")"
no_jobs --name="$name"
[[ ! -e $out/resumed/slurm ]] || fail "left: $(find "$out/resumed/slurm")"
done_before=$(find "$out/resumed" -name summary.json | wc -l)
((done_before < 10)) || fail "nothing was interrupted"
first=$(stat -c %Y.%i "$out/resumed/seed-0001/summary.json")
trials --trials 10 --out "$out/resumed" >"$out/said" 2>&1 ||
  fail "$(cat "$out/said") $(grep -h 'waiting for' "$out"/resumed/slurm/*/runs/*/tcsim.log 2>/dev/null || true)"
grep -q "^$done_before of 10 trials are done already" "$out/said" || fail "$done_before: $(cat "$out/said")"
[[ $(stat -c %Y.%i "$out/resumed/seed-0001/summary.json") == "$first" ]] || fail "what was done was run again"
(($(find "$out/resumed" -name summary.json | wc -l) == 10)) || fail "$(cat "$out/said")"
all_done
no_jobs

# A caller that is killed leaves jobs that change nothing any more once there is another call.
long --trials 2 --out "$out/killed" >"$out/killed.said" 2>&1 &
call=$!
begun killed
# shellcheck disable=SC2046
kill -KILL $(with_descendants "$call")
wait "$call" 2>/dev/null || true
# Its descendants are not this shell's to wait for, and the folder is theirs until the kernel is through with them.
# The runs of its jobs, which are to go on, write to a folder in that one.
for _ in $(seq 200); do pgrep -f -- "--out $out/killed\$" >/dev/null || break; sleep 0.05; done
[[ -n $(squeue -h) ]] || fail "the jobs are gone by themselves, so this shows nothing"
trials --restart --trials 2 --out "$out/killed" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
no_jobs
grep -q '^scenario .* 2 of 2' "$out/said" || fail "$(cat "$out/said")"
nothing_is_left() { pgrep -af "$mark" | grep -v "^$$ "; }
for _ in $(seq 100); do nothing_is_left >/dev/null || break; sleep 0.1; done
nothing_is_left && fail "is still there"
true
