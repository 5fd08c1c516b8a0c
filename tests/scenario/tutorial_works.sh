#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Every command of docs/TUTORIAL.md works as it is printed, one after the other, and the results are
# those that it tells of.
# Topics: examples, dds, report.
type idlc gcc python3 >/dev/null 2>&1 || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/build"
ln -s "$build" "$work/build/release"
cp -r "$source_root/examples" "$work/examples"
ln -s "$source_root/coordinator" "$work/coordinator"

export build PATH=$build/bin:$PATH
python3 -B "$source_root/tests/scenario/documented_commands.py" "$source_root" "$work" docs/TUTORIAL.md >"$work/said" 2>&1 ||
  fail "$(tail -n 20 "$work/said")"
(($(grep -c '^docs/TUTORIAL.md:' "$work/said") > 15)) || fail "the tutorial has lost its commands"
# Those of the slow computer, which the tutorial tells of.
(($(grep -c 'warning:' "$work/said") == 2)) || fail "not two warnings: $(grep 'warning:' "$work/said")"

near() {  # FOLDER: whether the drone ended within 20 mm of 1, 2, 3
  tail -n 1 "$work/my_robot/$1/bodies.csv" |
    awk -F, '{exit !(($3-1)^2 + ($4-2)^2 + ($5-3)^2 < 0.02^2)}'
}
near out || fail "the DDS controller does not hold the drone"
(($(grep -c 'not as expected: hover.yaml' "$work/said") == 4)) || fail "not what it is about: $(cat "$work/said")"
! near slow || fail "a computer a hundred times slower makes no difference"
grep -q 'drone/controller' <(grep '/wrench' "$work/said") || fail "nobody wrote /wrench"
grep -Eq '^planner +0.5 ' "$work/said" || fail "the report lacks the sweep: $(cat "$work/said")"
[[ -s $work/my_robot/sweep.html ]] || fail "there is no report"
