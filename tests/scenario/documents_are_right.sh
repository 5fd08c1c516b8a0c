#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Every command of README.md and docs/DEBUGGING.md works as it stands there and prints what is shown (the tutorial's:
# tutorial_works). documented_commands.txt names those that no test can run.
# Topics: examples, report.
type python3 >/dev/null 2>&1 || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export build PATH=$build/bin:$PATH
mkdir "$work/readme"
python3 -B "$source_root/tests/scenario/documented_commands.py" "$source_root" "$work/readme" README.md
# Debugging begins with a run that has ended, with a topic.
(cd "$work" && tcsim new hover && cd hover &&
  printf '  odometry: {type: dds, sensors: {bodies: [drone], message: nav_msgs/msg/Odometry, topic: /odom}}\n' >>scenario.yaml && tcsim run) \
  >"$work/said" 2>&1 || fail "$(cat "$work/said")"
python3 -B "$source_root/tests/scenario/documented_commands.py" "$source_root" "$work/hover" docs/DEBUGGING.md
