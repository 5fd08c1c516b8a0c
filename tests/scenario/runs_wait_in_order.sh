#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Runs that wait for a processor get it in the order in which they came, whatever becomes of those ahead of them, and
# say how many runs are ahead.
# Topics: host processors.
out=$(mktemp -d)
holders=() runs=()
trap 'kill "${holders[@]}" 2>/dev/null || true; kill -9 "${runs[@]}" 2>/dev/null || true; rm -rf "$out"' EXIT
mapfile -t allowed < <(taskset -pc $$ | sed 's/.*: //' | tr ',' '\n' | while IFS=- read -r a b; do seq "$a" "${b:-$a}"; done)
two=${allowed[*]: -2}
two=${two// /,}
((${#allowed[@]} > 1)) || exit 77
chrt -f 14 true 2>/dev/null || exit 77  # without real-time priorities runs wait for nothing

await() {  # WHAT COMMAND...: until it is true
  local what=$1 _
  shift
  for _ in $(seq 1200); do "$@" && return; sleep 0.05; done
  fail "$what: $(tail -n 3 "$out"/*.said)"
}
# It has said so, and by whom and of what is its own affair: others may have come in between.
waits() { grep -q 'waiting for one of them, ' "$out/$1.said"; }
says_new_place() { grep -Eq 'have the processors; (this run is the next one|[0-9]+ runs? .* ahead of this one)$' "$out/$1.said"; }
begun() { [[ -e $out/$1.begun ]]; }
held() { [[ $(cat "$out"/held* 2>/dev/null | wc -l) == 2 ]]; }
# Waits for a processor, says that it has one, and keeps it until it is let go.
begin() {  # NAME
  taskset -c "$two" "$tcsim" exec -- sh -c "touch '$out/$1.begun'; read line <'$out/$1.go'" >"$out/$1.said" 2>&1 &
  pid=$!
}

for cpu in ${two//,/ }; do
  flock --no-fork "/sys/devices/system/cpu/cpu$cpu" sh -c "echo held >'$out/held$cpu'; exec sleep 200" &
  holders+=($!)
done
await "the processors are not had" held
names=(1 2 3 killed 4 stopped 5 6 7 8 9 10)
declare -A pid_of
for name in "${names[@]}"; do
  mkfifo "$out/$name.go"
  begin "$name"
  runs+=("$pid")
  pid_of[$name]=$pid
  await "run $name does not wait" waits "$name"
done
# How many are ahead: of ours, and of others that may have come first.
place() { sed -n 's/.*waiting for one of them, \(this run is the next one\|\([0-9]*\) runs\? .* ahead of this one\)$/\2/p' "$out/$1.said"; }
for i in "${!names[@]}"; do
  ahead=$(place "${names[$i]}")
  ((${ahead:-0} >= i)) || fail "run ${names[$i]} has $ahead ahead instead of $i: $(cat "$out/${names[$i]}.said")"
done

# Neither the one that dies nor the one that stops keeps a place that others wait for.
kill -9 "${pid_of[killed]}"
coordinator=$(coordinator_of "${pid_of[stopped]}")
kill -STOP "$coordinator" "${pid_of[stopped]}"
# A process stops once it has the processor.
is_stopped() { [[ $(ps -o state= "$1") == T ]]; }
await "the coordinator does not stop" is_stopped "$coordinator"
kill "${holders[@]}"
holders=()
for k in $(seq 10); do
  await "run $k does not begin" begun "$k"
  # On two processors, the next one may have begun, and nobody who came later.
  for later in $(seq $((k + 2)) 10); do
    ! begun "$later" || fail "run $later has begun before run $k has ended"
  done
  ! begun stopped || fail "the run that is stopped has begun"
  ((k + 2 > 10)) || await "run $((k + 2)) does not say its new place" says_new_place $((k + 2))
  echo >"$out/$k.go"
  wait "${pid_of[$k]}" || fail "run $k: $(cat "$out/$k.said")"
done
# The one that was stopped goes on where it was.
kill -CONT "${pid_of[stopped]}" "$(coordinator_of "${pid_of[stopped]}")"
await "the run that was stopped does not begin" begun stopped
echo >"$out/stopped.go"
wait "${pid_of[stopped]}" || fail "the run that was stopped: $(cat "$out/stopped.said")"
runs=()
true
