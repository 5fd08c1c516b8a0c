#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A talker and a listener at 1 kHz, of rclcpp and of rclpy: each message arrives, in order, later than it was sent, at the rate at
# which it was sent, natively and under tcs, by endpoints and by sockets; and nothing is said on stderr that natively is not.
build_nodes
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT
use_folder "$out"
pair() { printf '%s listener %s & %s talker %s %s; wait' "$1" "$2" "$1" "$2" "$3"; }
cpp=$nodes/talk python="python3 $here/nodes/talk.py"
as_sent() {  # COUNT HZ LATEST_US: of what the listener says
  python3 - "$out/said" "$@" <<'PY'
import re, sys
file, count, hertz, latest = sys.argv[1], *map(float, sys.argv[2:])
found = re.fullmatch(r"(\d+) in order, late by (\S+) to (\S+) us, half by (\S+), at (\S+) Hz\n", open(file).read())
assert found, open(file).read()
number, least, most, half, rate = map(float, found.groups())
assert number == count and abs(rate / hertz - 1) < 0.01, found[0]
assert 0 < least and most < latest, found[0]
PY
}
timeout 60 bash -c "$(pair "$cpp" 1000 1000)" >"$out/said" 2>"$out/native" || fail "natively: $(cat "$out/said" "$out/native")"
[[ $(cat "$out/said") == "1000 in order"* ]] || fail "natively: $(cat "$out/said")"
[[ ! -s $out/native ]] || fail "natively: $(cat "$out/native")"
for accounting in measured fixed; do
  for dds in endpoints sockets; do
    for program in cpp python; do
      hertz=1000 count=1000 latest=50000
      [[ $program == cpp ]] || hertz=100 count=100
      timeout 300 "$tcsim" exec --accounting "$accounting" --dds "$dds" -- bash -c "$(pair "${!program}" "$count" $((1000000 / hertz)))" \
        >"$out/said" 2>"$out/errors" || fail "$program, $accounting, $dds: $(cat "$out/said" "$out/errors")"
      as_sent "$count" "$hertz" "$latest" || fail "$program, $accounting, $dds"
      [[ -z $(without_waits <"$out/errors") ]] || fail "$program, $accounting, $dds: $(cat "$out/errors")"
      printf '%-6s %-8s %-9s %s\n' "$program" "$accounting" "$dds" "$(cat "$out/said")"
    done
  done
done
