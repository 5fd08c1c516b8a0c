#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# `tcsim trace` makes one compressed trace of a run: who ran when, an arrow from each message's send to its receive,
# counters of poses and commands, what programs printed; all of it as the run's tables have it.
# Topics: recording, examples.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
refused() {  # what is to be said, arguments
  local said=$1
  shift
  if "$tcsim" trace "$@" >"$out/said" 2>&1; then fail "tcsim trace $* went well"; fi
  grep -q "$said" "$out/said" && [[ $(wc -l <"$out/said") == 1 ]] || fail "$(cat "$out/said")"
}

"$build/bin/in_own_network" "$tcsim" run "$build/examples/predator_prey/scenario.yaml" \
  --accounting fixed --duration 2.5s --out "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
"$tcsim" trace "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
gzip -t "$out/run/trace.json.gz" || fail "gzip does not take it"
python3 "$(dirname -- "${BASH_SOURCE[0]}")/trace_shows_messages.py" "$out/run" || fail "the trace is wrong"

"$tcsim" trace "$out/run" --out "$out/again.gz" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
cmp "$out/run/trace.json.gz" "$out/again.gz" || fail "two traces of one run differ"

# Of a run that was killed: what its tables end with counts.
mkdir "$out/cut"
cp "$out/run"/* "$out/cut"
rm "$out/cut/trace.json.gz"
for table in bodies commands messages output; do truncate -s -7 "$out/cut/$table.csv"; done
"$tcsim" trace "$out/cut" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
gzip -t "$out/cut/trace.json.gz" || fail "the trace of a killed run is not whole"

# Of a recorded run: datagrams, between programs and with the world, and what sensors measured. To be recorded changes
# nothing else, and repeats.
hover() { "$tcsim" run "$build/examples/quadrotor/scenario.yaml" --accounting fixed --duration 1s --out "$out/$1" "${@:2}" \
  >"$out/said" 2>&1 || fail "$(cat "$out/said")"; }
hover recorded --record
hover again --record
hover plain
for table in datagrams sensors; do
  cmp "$out/recorded/$table.csv" "$out/again/$table.csv" || fail "a second run writes another $table.csv"
  [[ ! -e $out/plain/$table.csv ]] || fail "$table.csv is there without a recording"
done
for table in bodies commands activations; do
  cmp "$out/recorded/$table.csv" "$out/plain/$table.csv" || fail "recorded, $table.csv is another one"
done
"$tcsim" trace "$out/recorded" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
python3 -B "$(dirname -- "${BASH_SOURCE[0]}")/trace_shows_datagrams.py" "$out/recorded" || fail "the trace of datagrams is wrong"
size=$(stat -c %s "$out/recorded/trace.json.gz")
((size < 1000000)) || fail "a second of a quadrotor is $size bytes"

mkdir "$out/empty"
refused "give a folder that .tcsim run. wrote" "$out/empty"
echo nonsense >"$out/empty/trace.json"
refused "is no schedule of a run" "$out/empty"
refused "was not written completely" "$out/run" --out /dev/full
refused "cannot be written" "$out/run" --out "$out/nowhere/trace.gz"
