#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Beside a program that does its worst an honest one prints to the byte what it prints alone, the run
# ends in time, and nothing is left of it. TCS_HOSTILE_ROUNDS asks for so many rounds, from TCS_HOSTILE_FIRST on;
# without it each kind of what it does has its turn once.
# Topics: isolation, determinism, clean-up.
first=${TCS_HOSTILE_FIRST:-0}
if [[ -n ${TCS_HOSTILE_ROUNDS:-} ]]; then
  seeds=($(seq "$first" $((first + TCS_HOSTILE_ROUNDS - 1)))) slow=()
else
  # 955 floods the pipe once, where 11 does so three times, which takes 13 s; it goes beside the others.
  seeds=({0..10} {12..31}) slow=(955)
fi
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
scenario() { # the hostile client's program and SEED, or nothing
  cat <<'YAML'
duration: 100ms
patience: 300ms
dynamics: {}
bodies: {ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
channels: {hands: {type: unix_json, commands: {body: ship, listen: "@${run}/hands"}}}
robots:
YAML
  printf '  one:\n    clients: {honest: {command: ["%s"], class: periodic}}\n' "$build/bin/honest"
  (($# == 0)) && return
  printf '  other:\n    clients: {hostile: {command: ["%s", "%s"], class: best-effort}}\n' "$1" "$2"
}
scenario >"$out/alone.yaml"
"$tcsim" run "$out/alone.yaml" --accounting fixed --out "$out/alone" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
grep -qx done "$out/alone/one-honest.out.log" || fail "the honest program was not done: $(cat "$out/alone/"*.log)"
rounds() {  # FOLDER SEEDS
  local at=$1 seed status deeds wrong sentences failed=0
  mkdir "$at"
  # A name of its own, by which all that is left can be found.
  cp "$build/bin/hostile" "$at/hostile"
  for seed in "${@:2}"; do
    scenario "$at/hostile" "$seed" >"$at/beside.yaml"
    status=0
    timeout -s KILL 200 "$tcsim" run "$at/beside.yaml" --accounting fixed --out "$at/beside" \
      >"$at/said" 2>"$at/warned" || status=$?
    deeds=$(cat "$at/beside/other-hostile.out.log" 2>/dev/null || true)
    wrong=""
    ((status == 137)) && wrong="hangs"
    cmp -s "$out/alone/one-honest.out.log" "$at/beside/one-honest.out.log" ||
      wrong="$wrong changes what another program prints"
    grep -q 'can be written\|has been written' <<<"$deeds" && wrong="$wrong writes where it must not"
    sentences=$(grep -c hostile "$at/warned" || true)
    ((sentences <= 3)) || wrong="$wrong is spoken of in $sentences sentences"
    grep -q 'bug in tcs\|fault of tcsim' "$at/warned" && wrong="$wrong finds a bug"
    none_left "$at/hostile" || wrong="$wrong leaves processes: $(pgrep -f "$at/hostile" || true)"
    # Runs have no files there while they go, either.
    [[ -z $(new_in_shm) ]] || wrong="$wrong leaves something in /dev/shm: $(new_in_shm)"
    if [[ -n $wrong ]]; then
      failed=$((failed + 1))
      printf '%s: %s (status %s)\n%s\n' "$deeds" "$wrong" "$status" "$(cat "$at/warned" "$at/said")" >&2
    fi
    [[ -z ${TCS_HOSTILE_SHOW:-} ]] || printf '%s -> %s %s\n' "$deeds" "$status" "$(cat "$at/warned")"
  done
  ((failed == 0)) || fail "$failed of $(($# - 1)) rounds"
}
beside rounds "$out/slow" "${slow[@]}"
beside rounds "$out/quick" "${seeds[@]}"
all_done
