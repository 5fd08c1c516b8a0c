#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# While the kernel holds the thread whose turn it is, others get the processor that were sent a
# signal or were stopped halfway in a call; and whatever they wait in may be interrupted, as where a
# container is frozen for a moment. Nothing of a fixed run may depend on that.
# Topics: determinism, threads, signals.
out=$(mktemp -d)
trap 'kill ${writer:-} 2>/dev/null || true; rm -rf "$out"' EXIT
mkfifo "$out/fifo"
cp "$build/bin/held_beside" "$out/held"
cat >"$out/scenario.yaml" <<END
duration: 1s
robots:
  robot:
    clients:
      held: {command: ["$out/held", "$out/fifo", "$out/begins"]}
END
fly() { # NAME: a run; all that it says is printed
  rm -f "$out/begins"
  timeout 200 "$tcsim" run "$out/scenario.yaml" --accounting fixed --out "$out/$1" >"$out/$1.said" 2>&1 ||
    fail "$1: status $?: $(cat "$out/$1.said")"
  cat "$out/$1/robot-held.out.log" "$out/$1/dispatches.csv" "$out/$1/activations.csv"
}
exec 7<>"$out/fifo"
# The bytes that it is held for are there; and come one by one.
printf 'x%.0s' $(seq 18) >&7
at_once=$(fly at_once)
rm -f "$out/begins"  # before anybody waits for the next run's
(
  until [[ -e $out/begins ]]; do sleep 0.05; done
  for _ in $(seq 18); do
    sleep 0.05
    "$build/bin/interrupter" "$(pgrep -o -f "^$out/held")" 2>>"$out/not_interrupted" || true
    sleep 0.01
    printf x >&7
  done
) &
writer=$!
later=$(fly later)
grep -q 'not permitted' "$out/not_interrupted" 2>/dev/null && echo 'nobody may be interrupted here' && exit 77
[[ ! -s $out/not_interrupted ]] || fail "$(cat "$out/not_interrupted")"
lines=$(grep -c 'early' <<<"$at_once" || true)
((lines == 18)) || fail "it was held $lines times: $at_once"
grep -q ' 0 early, 1 later' <<<"$at_once" || fail "$at_once"
diff <(echo "$at_once") <(echo "$later") >"$out/diff" || fail "$(head -20 "$out/diff")"
