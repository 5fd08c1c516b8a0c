#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Beside a program that does its worst an honest one prints to the byte what it prints alone, the run
# ends in time, and nothing is left of it. TCS_HOSTILE_ROUNDS asks for more rounds than the kinds of
# what it does, TCS_HOSTILE_FIRST for another one to begin with.
# Topics: isolation, determinism, clean-up.
rounds=${TCS_HOSTILE_ROUNDS:-32}
first=${TCS_HOSTILE_FIRST:-0}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
scenario() { # SEED of the hostile client, or nothing
  cat <<'YAML'
duration: 100ms
dynamics: {}
bodies: {ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
channels: {hands: {type: unix_json, commands: {body: ship, listen: "@${run}/hands"}}}
robots:
YAML
  printf '  one:\n    clients: {honest: {command: ["%s"], class: periodic}}\n' "$build/bin/honest"
  (($# == 0)) && return
  printf '  other:\n    clients: {hostile: {command: ["%s", "%s"], class: best-effort}}\n' "$out/hostile" "$1"
}
# A name of its own, by which all that is left can be found.
cp "$build/bin/hostile" "$out/hostile"
scenario >"$out/alone.yaml"
"$tcsim" run "$out/alone.yaml" --accounting fixed --out "$out/alone" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
grep -qx done "$out/alone/one-honest.out.log" || fail "the honest program was not done: $(cat "$out/alone/"*.log)"
failed=0
for ((seed = first; seed < first + rounds; ++seed)); do
  scenario "$seed" >"$out/beside.yaml"
  status=0
  timeout -s KILL 60 "$tcsim" run "$out/beside.yaml" --accounting fixed --out "$out/beside" \
    >"$out/said" 2>"$out/warned" || status=$?
  deeds=$(cat "$out/beside/other-hostile.out.log" 2>/dev/null || true)
  wrong=""
  ((status == 137)) && wrong="hangs"
  cmp -s "$out/alone/one-honest.out.log" "$out/beside/one-honest.out.log" ||
    wrong="$wrong changes what another program prints"
  grep -q 'can be written\|has been written' <<<"$deeds" && wrong="$wrong writes where it must not"
  sentences=$(grep -c hostile "$out/warned" || true)
  ((sentences <= 3)) || wrong="$wrong is spoken of in $sentences sentences"
  grep -q 'bug in tcs\|fault of tcsim' "$out/warned" && wrong="$wrong finds a bug"
  left=$(pgrep -f "$out/hostile" || true)
  [[ -z $left ]] || wrong="$wrong leaves processes: $left"
  [[ -z $(new_in_shm) ]] || wrong="$wrong leaves something in /dev/shm: $(new_in_shm)"
  if [[ -n $wrong ]]; then
    failed=$((failed + 1))
    printf '%s: %s (status %s)\n%s\n' "$deeds" "$wrong" "$status" "$(cat "$out/warned" "$out/said")" >&2
  fi
  [[ -z ${TCS_HOSTILE_SHOW:-} ]] || printf '%s -> %s %s\n' "$deeds" "$status" "$(cat "$out/warned")"
done
((failed == 0)) || fail "$failed of $rounds rounds"
