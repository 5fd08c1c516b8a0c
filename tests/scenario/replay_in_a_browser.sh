#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The world of a run, shown again in a browser: the robot is where bodies.csv says, whichever way the time
# is set (slider, keys, playing, a click in the timeline or on what a program said); at 400 pixels, by
# touch, in the dark, in print, and without WebGL. Contact forces are arrows, which point where they push.
# Topics: report, contacts, examples.
for command in chromium chromedriver; do
  command -v "$command" >/dev/null || fail "$command is not installed (cmake/packages.txt)"
done
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
show() {  # NAME SCENARIO OPTIONS
  "$tcsim" run "$2" --accounting fixed --out "$out/$1" "${@:3}" >"$out/$1.said" || fail "$(cat "$out/$1.said")"
  "$tcsim" report "$out/$1" --out "$out/$1.html" >"$out/$1.said" || fail "$(cat "$out/$1.said")"
  (($(stat -c %s "$out/$1.html") < 2000000)) || fail "the page of a few seconds is large"
}
beside show rover "$build/examples/rover/scenario.yaml" --duration 4s
cat >"$out/talk.yaml" <<'YAML'
duration: 2s
dynamics: {}
bodies: {drone: {mass: 1, inertia: [0.1, 0.1, 0.1], linear_velocity: [1, 0, 0]}}
robots:
  drone:
    clients:
      talker: {command: [python3, -u, -c, "import time\nfor i in range(4):\n  time.sleep(0.4)\n  print('mark: half way' if i == 1 else 'tick <%.6f>' % time.monotonic())"]}
YAML
beside show talk "$out/talk.yaml"
cat >"$out/crates.yaml" <<'YAML'
duration: 2s
csv_contacts: true
dynamics: {gravity: [0, 0, -9.81]}
models:
  floor: {plane: [0, 0, 1]}
  crate: {box: [0.4, 0.4, 0.4], mass: 2, position: [0, 0, 0.2]}
  lid: {box: [0.2, 0.2, 0.2], mass: 1, position: [0, 0, 1.2]}
robots: {r: {clients: {c: {command: [sleep, "2"]}}}}
YAML
beside show crates "$out/crates.yaml"
all_done
cd "$(dirname -- "${BASH_SOURCE[0]}")"
timeout 880 python3 -B replay_in_a_browser.py "$out" || fail "the page is not as it should be"
