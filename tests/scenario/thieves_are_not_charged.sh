#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Who takes the processor away in the middle of a program's work is not paid for by the program:
# neither where the kernel charges the thief, nor where no clock tells. What was left out is shown.
# Topics: accounting, host processors.
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT

# THIEF SIZE: a program works while the processor is taken away for some 30 ms five times.
work_beside() {
  local out=$directory/$1-$2 pid='' thief=0
  printf '%s\n' 'duration: 100s' "robots: {robot: {clients:
    {worker: {command: ['$build/bin/steady_worker', '$2', '1000000']}}}}" > "$directory/scenario.yaml"
  "$tcsim" run "$directory/scenario.yaml" --out "$out" > "$out.txt" 2>&1 &
  local run=$!
  while [ -z "$pid" ]; do
    [ -e "/proc/$run" ] || { cat "$out.txt"; fail "the run has ended before its program began"; }
    sleep 0.02
    pid=$(head -n 1 "$out/robot-worker.err.log" 2> /dev/null) || true
  done
  "$build/bin/processor_thief" "$1" "$pid" 5 > "$out.thief" || thief=$?
  wait "$run" || { cat "$out.txt"; fail "the run beside $1 has failed"; }
  [ "$thief" != 77 ] || exit 77
  { read -r median most _; read -r dearest; } < "$out/robot-worker.out.log"
  echo "$1, $2: $median us, at most $most us ($dearest); $(cat "$out.thief")"
  # A theft that no clock tells of is found by a timer that is set anew every 4.1 ms.
  awk -v median="$median" -v most="$most" 'BEGIN { exit !(most < 3 * median + 8000) }' ||
    fail "$2 work beside $1 is charged $most us where it takes $median us"
  python3 - "$out" "$out.txt" "$1 $2" <<'EOF' || fail "$2 work beside $1: the summary"
import json, sys
summary = json.load(open(sys.argv[1] + '/summary.json'))
worker = summary['clients']['robot/worker']
printed = open(sys.argv[2]).read()
print({key: summary[key] for key in ('unaccounted_steals', 'unaccounted_steal_ns')}, worker)
assert ('no clock of the kernel showed it' in printed) == (summary['unaccounted_steals'] > 0), printed
assert worker['stolen_ns'] >= summary['unaccounted_steal_ns']
assert summary['unaccounted_steals'] > 0 or sys.argv[3] != 'interrupts long', 'no theft was found'
assert abs(worker['charged_ns'] / worker['host_cpu_ns'] - 1) < 0.03
EOF
}

work_beside interrupts long
work_beside interrupts short
work_beside computing long
work_beside computing short
