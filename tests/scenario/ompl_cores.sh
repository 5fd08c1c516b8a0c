#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Stock OMPL with threads, as it is, on one core and on four. Four planners on four cores explore
# about four times as much in the same virtual time as the same four on one core.
# Topics: ompl, cores, threads.
plan() { "$tcsim" exec --cores "$1" -- "$build/bin/ompl_planners" "$2" 0.3; }
checks() { plan "$1" parallel | awk '{for (i = 2; i <= NF; ++i) if ($i == "checks,") print $(i - 1)}'; }
# How fast the host is may change between the two: another try then.
for try in 1 2 3; do
  one=$(checks 1)
  four=$(checks 4)
  ((four > 3 * one && four < 5 * one)) && break
  ((try < 3)) || fail "four planners make $four checks on four cores, and $one on one"
done
for cores in 1 4; do
  for which in rrtstar prmstar cforest anytime sst; do
    said=$(plan "$cores" "$which") || fail "$which on $cores cores: $said"
    # The clock is read inline, or by a thread every 3 ms. What another core's thread writes is seen
    # up to the drift bound of 1 ms early.
    awk '{for (i = 1; i < NF; ++i) if ($i == "took") exit !($(i + 1) > 0.299 && $(i + 1) < 0.4)}' \
      <<<"$said" || fail "$which on $cores cores does not take 0.3 s: $said"
  done
  said=$(plan "$cores" benchmark) || fail "benchmark on $cores cores: $said"
  [[ $(grep -c '^geometric_.*: 0\.3[0-9]* s, [1-9]' <<<"$said") == 4 ]] ||
    fail "benchmark on $cores cores: $said"
done
