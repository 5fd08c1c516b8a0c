#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# At the run's end SIGINT goes to the main thread, as the kernel has it, while all of the program's threads wait for each
# other: none of them is told that a signal has ended its wait but that one. So also where more threads have ended
# before than the coordinator keeps, so that the main thread has no place before the others.
# Topics: ends, signals, threads, containers.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chmod 755 "$out"
install -m 755 "$build/bin/asked_to_stop" "$out"
client() {  # NAME ENDED_BEFORE
  echo "      $1: {command: [bash, -c, 'for i in \$(seq $2); do /bin/true; done; exec $out/asked_to_stop'], stop_signal: SIGINT, stop_grace: 10s}"
}
{
  # Time goes by at once where all wait: enough of it for a busy host's forks, and real time for the grace, which is
  # some twice as long at most.
  printf 'duration: 20s\nrobots:\n  r:\n    clients:\n'
  client none 0
  client some 33
  client many 70
} >"$out/s.yaml"
check() {  # WHAT FOLDER
  local name
  for name in none some many; do
    [[ $(cat "$2/r-$name.out.log") == 'ended well' ]] || fail "$1: $name: $(tail -n 99 "$2"/*.log "$out/said")"
  done
}
for accounting in measured fixed; do
  timeout 150 "$tcsim" run "$out/s.yaml" --accounting "$accounting" --out "$out/$accounting" >"$out/said" 2>&1 ||
    fail "$accounting: status $?: $(cat "$out/said")"
  check "$accounting" "$out/$accounting"
done
