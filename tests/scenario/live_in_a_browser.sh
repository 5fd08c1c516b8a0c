#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A run watched in a browser while it goes: the robot is where bodies.csv says, the page goes with the run,
# pauses, steps and paces it by its buttons; at 400 pixels and in the dark; afterwards `tcsim view` shows it.
# Topics: live page, examples.
for command in chromium chromedriver; do
  command -v "$command" >/dev/null || fail "$command is not installed (cmake/packages.txt)"
done
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$(dirname -- "${BASH_SOURCE[0]}")"
timeout 880 python3 -B live_in_a_browser.py "$tcsim" "$build/examples/rover/scenario.yaml" "$out" || fail "the page is not as it should be"
