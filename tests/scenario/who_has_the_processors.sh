#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Where other runs have all processors, a run says who has them; with --no-wait it fails at once.
# Topics: host processors, failures.
out=$(mktemp -d)
holders=()
trap 'for pid in "${holders[@]}"; do kill "$pid" 2>/dev/null || true; done; rm -rf "$out"' EXIT
# As many claims as there are processors for runs: here a shell holds them, as a run would.
cpus=$(taskset -pc $$ | sed 's/.*: //')
for folder in /sys/devices/system/cpu/cpu[0-9]*; do
  flock --no-fork "$folder" sleep 200 &
  holders+=($!)
done
claimed=
for _ in $(seq 300); do
  status=0
  timeout 60 "$tcsim" exec --no-wait -- true >"$out/stdout" 2>"$out/stderr" || status=$?
  grep -q ': sleep 200' "$out/stderr" && claimed=yes && break
  sleep 0.1
done
[[ $claimed == yes ]] || fail "status $status: $(cat "$out/stderr") (of $cpus)"
((status == 2)) || fail "exit status $status instead of 2"
[[ $(wc -l <"$out/stderr") == 1 ]] || fail "not one line: $(cat "$out/stderr")"
grep -Eq '^tcsim: other runs of tcsim have the processors \(CPU [0-9]+: pid [0-9]+, for [0-9]+ s: .*; wait for one of them, or run without --no-wait$' \
  "$out/stderr" || fail "$(cat "$out/stderr")"
# So do trials.
printf '%s\n' 'duration: 1s' 'robots: {r: {clients: {c: {command: ["true"]}}}}' >"$out/s.yaml"
status=0
timeout 60 "$tcsim" trials "$out/s.yaml" --trials 2 --no-wait --out "$out/trials" \
  >"$out/stdout" 2>"$out/stderr" || status=$?
((status == 2)) || fail "trials: exit status $status instead of 2: $(cat "$out/stderr")"
grep -Eq '^tcsim: other runs of tcsim have the processors .*; wait for one of them, or run without --no-wait$' \
  "$out/stderr" || fail "trials: $(cat "$out/stderr")"
[[ ! -e $out/trials/seed-0001 ]] || fail "a trial was begun"
# Who waits says the same, and goes on when there is one.
timeout 150 "$tcsim" exec -- true 2>"$out/waited" &
waiter=$!
for _ in $(seq 600); do grep -q 'waiting for one' "$out/waited" && break; sleep 0.1; done
for pid in "${holders[@]}"; do kill "$pid" 2>/dev/null || true; done
wait "$waiter" || fail "it did not go on: $(cat "$out/waited")"
grep -Eq 'have the processors \(CPU [0-9]+: pid [0-9]+.*; waiting for one of them, (this run is the next one|[0-9]+ runs? .* ahead of this one)$' "$out/waited" || fail "$(cat "$out/waited")"
