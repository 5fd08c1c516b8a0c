#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The recording of a whole run in MCAP is read by Foxglove's reader: its messages decode to what was written, on
# DDS, on channels of JSON and of the world; it has what the same run's bag in SQLite has; and what was recorded
# until the coordinator was killed can be read.
# Topics: recording, dds, failures.
if ! MCAP_READER=$("$source_root/tests/mcap/install.sh" "$build" 2>&1); then
  printf 'SKIPPED: %s\n' "$MCAP_READER"
  exit 77
fi
export MCAP_READER
out=$(mktemp -d)
run=
trap '[[ -z $run ]] || kill -9 "$run" 2>/dev/null || true; rm -rf "$out"' EXIT
check() { python3 "$(dirname -- "${BASH_SOURCE[0]}")/recording.py" "$@" || fail "recording.py $*"; }
# The example's ports may be somebody else's on this host.
example() {
  "$build/bin/in_own_network" "$tcsim" run "$build/examples/predator_prey/scenario.yaml" --set 'clock={}' \
    --accounting fixed --duration 1.2s "$@" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
}

example --record mcap --out "$out/first"
example --record=mcap --out "$out/second"
example --record --out "$out/sqlite"
check example "$out/first"
check world "$out/first"
check same "$out/first" "$out/second"
check alike "$out/sqlite" "$out/first"
# The storage is nothing to programs.
for file in bodies.csv activations.csv topics.json; do
  cmp "$out/first/$file" "$out/sqlite/$file" || fail "$file differs"
done
# One storage takes the other's place.
example --record --out "$out/first"
[[ ! -e $out/first/bag/bag_0.mcap && -e $out/first/bag/bag_0.db3 ]] || fail "$(ls "$out/first/bag")"

if "$tcsim" run "$build/examples/predator_prey/scenario.yaml" --record=rosbag >"$out/said" 2>&1; then
  fail "there is no storage rosbag"
fi
grep -q mcap "$out/said" || fail "$(cat "$out/said")"

"$build/bin/in_own_network" "$tcsim" run "$build/examples/predator_prey/scenario.yaml" --accounting fixed \
  --duration 1h --record mcap --out "$out/killed" >"$out/said" 2>&1 &
run=$!
kill_once_recorded "$run" "$out/killed/bag" 1000
run=
check cut-off "$out/killed"
