#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$(dirname -- "${BASH_SOURCE[0]}")/trials_world.sh"
# Whichever process of `tcsim trials` is killed, and however: nothing of its runs is left, and the
# next call goes on.
# Topics: trials, clean-up.
victims() {  # what to kill of the call whose process is $1
  case $2 in
    guardian) echo "$1" ;;
    trials) coordinator_of "$1" ;;
    both) echo "$1 $(coordinator_of "$1")" ;;
    run) pgrep -P "$(coordinator_of "$1")" ;;
  esac
}
for victim in guardian:KILL trials:KILL both:KILL guardian:TERM guardian:HUP; do
  "$tcsim" trials "$out/scenario.yaml" --duration 1h --trials 2 --out "$out/t" >/dev/null 2>&1 &
  call=$!
  for _ in $(seq 1000); do pgrep -f "python.*$mark" >/dev/null && break; sleep 0.1; done
  pgrep -f "python.*$mark" >/dev/null || fail "no trial has begun"
  # shellcheck disable=SC2046
  kill "-${victim#*:}" $(victims "$call" "${victim%:*}")
  wait "$call" 2>/dev/null || true
  nothing_is_left "$victim"
done
[[ -z $(new_in_shm) ]] || fail "something is left in /dev/shm: $(new_in_shm)"

# A run that is killed is one trial that failed.
"$tcsim" trials "$out/scenario.yaml" --duration 1h --trials 1 --out "$out/t" >"$out/said" 2>&1 &
call=$!
for _ in $(seq 1000); do pgrep -f "python.*$mark" >/dev/null && break; sleep 0.1; done
kill -KILL "$(victims "$call" run)"
status=0; wait "$call" || status=$?
((status == 1)) || fail "exit status $status: $(cat "$out/said")"
grep -Eq 'seed 1 failed: .*(was killed|signal 9)' "$out/said" || fail "$(cat "$out/said")"
nothing_is_left run
