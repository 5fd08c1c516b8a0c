#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Somebody looks into /proc all the time, as `top` does, while processes of several threads end and
# are reaped. The threads themselves remove their entries there, in the kernel: were one of them kept
# from it, whoever reaps its process would spin in the kernel for ever. Another argument: how many processes.
# Topics: processes, threads.
children=${3:-2000}
seconds=$((children * 3 / 100 + 150))  # it may have to wait for a processor
watchers=()
trap '((${#watchers[@]})) && kill "${watchers[@]}" 2>/dev/null; true' EXIT
for ((cpu = 0; cpu < $(nproc); ++cpu)); do
  taskset -c "$cpu" "$build/bin/dying_threads" watch "$seconds" &
  watchers+=($!)
done
said="$(timeout "$seconds" "$tcsim" exec -- "$build/bin/dying_threads" "$children")" || fail "ended with $?: $said"
[[ $said == "all reaped" ]] || fail "it said: $said"
