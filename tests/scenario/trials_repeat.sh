#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$(dirname -- "${BASH_SOURCE[0]}")/trials_world.sh"
# Trials side by side are the same runs as alone, to the byte, whoever has their ports on this
# machine; so are those of a call that was interrupted and made again.
# Topics: trials, determinism, network.
unshare --net true 2>/dev/null || exit 77
seeds=$(seq 4 7)
for seed in $seeds; do
  "$tcsim" run "$out/scenario.yaml" --accounting fixed --seed "$seed" --out "$out/alone/$seed" \
    >/dev/null 2>&1
done
cmp -s "$out/alone/4/bodies.csv" "$out/alone/5/bodies.csv" && fail "all seeds fly the same way"

python3 -c '
import socket, sys, time
held = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in sys.argv[2:]]
for s, port in zip(held, sys.argv[2:]): s.bind(("127.0.0.1", int(port)))
print("bound", flush=True); time.sleep(300)' "$mark" 27440 27441 >"$out/holder" &
holder=$!
for _ in $(seq 600); do grep -q bound "$out/holder" && break; sleep 0.1; done
set -m
trials=("$tcsim" trials "$out/scenario.yaml" --accounting fixed --first-seed 4 --trials 4)
"${trials[@]}" --jobs 2 --out "$out/at_once" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
grep -Eq '^scenario +4 of 4' "$out/said" || fail "$(cat "$out/said")"
for seed in $seeds; do same "$out/at_once/seed-000$seed" "$out/alone/$seed"; done

# As ^C does it: to all processes of the terminal.
"${trials[@]}" --jobs 1 --out "$out/resumed" >"$out/said" 2>&1 &
call=$!
# The other three take less than a second.
be_on_time
for _ in $(seq 2400); do [[ -e $out/resumed/seed-0004/summary.json ]] && break; sleep 0.05; done
kill -INT -- "-$call"
be_ordinary
status=0; wait "$call" || status=$?
((status == 130)) || fail "exit status $status after ^C: $(cat "$out/said")"
grep -q 'interrupted; [1-3] of 4 trials are done, and the same call goes on' "$out/said" ||
  fail "$(cat "$out/said")"
[[ -e $out/resumed/seed-0007/summary.json ]] && fail "nothing was interrupted"
pgrep -af "$mark" | grep -v "^$holder " && fail "something is left of the interrupted trials"
first=$(stat -c %Y.%i "$out/resumed/seed-0004/summary.json")
"${trials[@]}" --jobs 1 --out "$out/resumed" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
grep -q '^[1-3] of 4 trials are done already' "$out/said" || fail "$(cat "$out/said")"
[[ $(stat -c %Y.%i "$out/resumed/seed-0004/summary.json") == "$first" ]] ||
  fail "what was done was run again"
for seed in $seeds; do same "$out/resumed/seed-000$seed" "$out/alone/$seed"; done
