#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/steadily.sh"
# OMPL's own demos as Debian ships them: they exit as they do natively and say what they say there,
# in virtual time. `--speed` makes those that plan for 10 s cost a fraction of that in real time.
#
# Not run here:
#   Diagonal N                   100 runs of 5 s of each planner: about 45 minutes, of virtual time, too
#   PlannerProgressProperties    50 runs of 2 s: natively 100 s, so there is nothing to compare with
#   HypercubeBenchmark 3         until all is solved: 24 s natively; from 4 on, more than a minute
#   VectorFieldConservative, VectorFieldNonconservative, StateSampling,
#   RigidBodyPlanningWithODESolverAndControls, RigidBodyPlanningWithIntegrationAndControls
#                                up to 10 s or 30 s natively, with no option to make it less
# Topics: ompl, ordinary programs.
demos=$build/bin/ompl_demos
[[ -x $demos/RigidBodyPlanning ]] || { echo "OMPL's demos are not built" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
cd "$work"
mkdir natively virtually first second

# What it exits with, and what it says when it has done its work.
demo() {
  local words=$2 native virtual=0 pid
  # A plan has so much real time there, of which a busy host gives it little.
  steadily "$build" natively "$@" 2>steady &
  pid=$!
  shift 2
  (cd virtually && exec "$tcsim" exec --speed 0.2 -- "$demos/$1" "${@:2}" >../virtual 2>&1) || virtual=$?
  wait "$pid" || fail "$* natively: $(<steady)"
  native=$(<exited)
  [[ $native != 134 ]] || words=Assertion
  [[ $virtual == "$native" ]] || fail "$* exits with $virtual, natively with $native: $(<virtual)"
  grep -q -- "$words" virtual || fail "$* does not say '$words': $(<virtual)"
}
natively() {  # STATUS WORDS COMMAND...
  local status=$1 words=$2 native=0
  shift 2
  (cd natively && exec "$demos/$1" "${@:2}" >../native 2>&1) || native=$?
  echo "$native" >exited
  # OMPL 1.5 ends this one on an assertion of Eigen, 1.6 does not.
  [[ $1 != HypercubeBenchmark || $native != 134 ]] || { status=134 words=Assertion; }
  [[ $native == "$status" ]] && grep -q -- "$words" native && return
  echo "exits with $native, not $status, or does not say '$words'" >&2
  return 1
}
demo 0 'Found solution' RigidBodyPlanning
demo 0 'Found solution' RigidBodyPlanningWithIK
demo 0 'Found stored solution' PlannerData
demo 0 '^17 17 ' GeometricCarPlanning --easyplan
demo 0 '^path 3 4 1' GeometricCarPlanning --trajectory 3 4 1
demo 0 'found a solution of length 1\.5' OptimalPlanning -t 0.5
demo 0 'Output saved' Koules --plan --numkoules 1
demo 0 'Benchmark complete' CForestCircleGridBenchmark --runtime-limit 0.1 --run-count 1
# It crashes natively in what it destroys after dCloseODE.
demo 139 '' OpenDERigidBodyPlanning
demo 0 'Benchmark complete' HypercubeBenchmark 2

# One that plans for a given time takes that time of the virtual clock, and in fixed accounting all of
# them, clock readings included, repeat.
repeats() {
  once() {
    cd "$1" && "$tcsim" exec --accounting fixed -- \
      sh -c 'date +%s.%N; "$@" || exit; date +%s.%N' sh "$demos/$2" "${@:3}" 2>&1 |
      without_waits >said || fail "${*:2} in fixed accounting: $(<said)"
  }
  beside once first "$@"
  beside once second "$@"
  all_done
  [[ -s first/said ]] && cmp first/said second/said || fail "two runs of $* differ"
}
for name in RigidBodyPlanning RigidBodyPlanningWithIK PlannerData; do repeats $name; done
repeats GeometricCarPlanning --easyplan
repeats Koules --plan --numkoules 1
repeats OptimalPlanning -t 0.2
awk 'NR == 1 {start = $1} END {took = $1 - start; exit !(took >= 0.2 && took < 0.21)}' first/said ||
  fail "OptimalPlanning -t 0.2 does not take 0.2 s: $(<first/said)"
