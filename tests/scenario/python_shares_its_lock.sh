#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Under set costs every round of a loop takes the same time. Python's threads get its lock from one another all the same, on one
# core and on four, whatever a call costs: pools of 2 to 8 processes, a loop of sleep(0) beside a thread that sets a flag, a loop
# of reads that find nothing beside a thread that reads. Each takes the time that it takes natively, and two runs are the same.
# Topics: languages, threads, processes, determinism.
program=$source_root/tests/scenario/runtimes/pool.py
takes() {  # WORKERS CORES COST
  said=$(timeout 200 "$tcsim" exec --accounting fixed --cores "$2" --call-cost "$3" -- python3 "$program" "$1" 2>&1) ||
    fail "$*: status $?: $said"
  said=$(without_waits <<<"$said")
  [[ $(wc -l <<<"$said") == 3 && $said != *"that is not"* ]] || fail "$*: $said"
}
for workers in 2 3 4 8; do
  for cores in 1 4; do takes "$workers" "$cores" 1us; done
done
for cost in 100ns 331ns 3127ns 10us; do takes 4 1 "$cost"; done
takes 4 4 1us
first=$said
takes 4 4 1us
[[ $said == "$first" ]] || fail "two runs differ: $first and $said"
