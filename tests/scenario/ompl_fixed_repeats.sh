#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Stock OMPL does the same in each run under fixed accounting, its threads included: states, costs
# and readings of the clock. And solve(0.4) takes 0.4 s: what it takes besides are up to 1 ms that
# OMPL's own thread sleeps at the end, 1 us for each of the calls that it has made, and what the
# planner does until it looks at the thread's flag: of PRMstar that is a search of its whole roadmap,
# thousands of allocations, of AnytimePathShortening a path's simplification.
# Topics: ompl, determinism, threads.
repeats() {
  local cores=$1 cost=$2 first second
  shift 2
  plan() {
    "$tcsim" exec --accounting fixed --cores "$cores" --allocation-cost "$cost" -- \
      "$build/bin/ompl_planners" "$@" 2>&1 | without_waits
  }
  first=$(plan "$@") || fail "$*: $first"
  second=$(plan "$@")
  [[ $first == "$second" ]] || fail "two runs of $* differ: '$first' and '$second'"
  [[ $first != *warning* ]] || fail "$*: $first"
  local most=0.406
  [[ $1 != @(prmstar|anytime) ]] || most=0.440
  awk -v most="$most" \
    '{for (i = 1; i < NF; ++i) if ($i == "took") exit !($(i + 1) >= 0.4 && $(i + 1) < most)}' \
    <<<"$first" || fail "not 0.4 s: $first"
  # Not because nothing happened.
  awk '{for (i = 2; i <= NF; ++i) if ($i == "checks,") exit !($(i - 1) > 10000)}' <<<"$first" ||
    fail "next to nothing was explored: $first"
}
for which in rrtconnect rrtstar prmstar sst; do repeats 1 10us "$which" 0.4; done
for which in parallel cforest anytime; do repeats 4 20us "$which" 0.4; done
# As it comes.
repeats 1 2us rrtconnect 0.4
