#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/dds/soak/scenario.sh"
# Under fixed accounting it changes nothing how long the environment is (the home directory, PATH, the folder that tcs is in), nor
# how many digits process numbers have: main's stack is at the same address, and DDS programs, which order things by their
# addresses, do the same at the same times.
# Topics: determinism, dds.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
lengths="0 7 40 3000"
long() { printf '%*s' "$1" '' | tr ' ' x; }
where() { for length in $lengths; do MORE=$(long "$length") "$tcsim" exec --accounting "$1" -- "$build/bin/stack_address"; done | sort -u; }
[[ $(where fixed | wc -l) == 1 ]] || fail "the stack is at $(where fixed)"
(($(where measured | wc -l) > 1)) || fail "where nothing has to repeat, the stack is where the kernel puts it"

soak_scenario "$build" 10000 >"$out/scenario.yaml"
fly() { # NAME LENGTH LAST_PID
  # Only root may say which number comes next.
  echo "$3" 2>/dev/null >/proc/sys/kernel/ns_last_pid || true
  MORE=$(long "$2") "$tcsim" run "$out/scenario.yaml" --accounting fixed --out "$out/$1" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  cat "$out/$1"/{dispatches.csv,activations.csv,*.out.log} >"$out/$1.all"
}
fly short 0 2000
[[ $(wc -l <"$out/short.all") -gt 1000 ]] || fail "next to nothing happened"
fly long 40 20000
fly longer 3000 9990
for other in long longer; do cmp "$out/short.all" "$out/$other.all" || fail "$other is another run"; done
