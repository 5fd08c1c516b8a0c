#!/usr/bin/env bash
# talks.sh BUILD NAME native|exec|network: two processes of a middleware's program. All messages are seen, in their order, and as
# late as they should be.
set -euo pipefail
build=$(realpath -- "$1") name=$2 variant=$3
here=$(dirname -- "${BASH_SOURCE[0]}")
source "$here/../steadily.sh"
complain() {
  echo "FAILED: $name, $variant, $*" >&2
  return 1
}

count=100
# nats-server (Go) does not always repeat, for a cause that is not known: it is not compared.
repeats=true
[[ $name != nats ]] || repeats=false
case $name in
  nats)
    command -v python3 >/dev/null && command -v nats-server >/dev/null || exit 77
    program=(python3 "$(realpath -- "$here/nats.py")")
    ;;
  *)
    [[ -x $build/bin/middleware_$name ]] || exit 77
    program=("$build/bin/middleware_$name")
    ;;
esac
here_only=tcp://127.0.0.1:2555 at_receiver=tcp://0.0.0.0:2555 at_sender=tcp://receiver:2555
if [[ $name == lcm ]]; then
  here_only="udpm://239.255.76.67:7667?ttl=0"
  at_receiver="udpm://239.255.76.67:7667?ttl=1" at_sender=$at_receiver
fi

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# judged FILE LEAST_US MOST_US FEW: what the receiver has said. What a message costs once is the host's where it is measured:
# then FEW may take 20 ms more.
judged() {
  awk -v least="$2" -v most="$3" -v few="$4" -v count="$count" '
    $1 != NR - 1 { printf "message %d is the %dth that was seen\n", $1, NR; bad = 1 }
    $2 < least * 1000 || $2 > (most + 20000) * 1000 || $2 > most * 1000 && ++late > few {
      printf "message %d took %d ns, %d are late\n", $1, $2, late
      bad = 1
    }
    END { if (NR != count) { printf "%d of %d messages were seen\n", NR, count; bad = 1 }
          exit bad }' "$1"
}

cat >"$out/both.sh" <<'END'
"${@:3}" receive "$1" "$2" &
receiver=$!
"${@:3}" send "$1" "$2"
wait $receiver
END

# here HOW LEAST_US MOST_US FEW COMMAND...: both on one computer, which nobody else has. Other runs may have the processors
# first.
here() {
  local status=0
  timeout 250 "$build/bin/in_own_network" "${@:5}" bash "$out/both.sh" "$here_only" "$count" "${program[@]}" \
    >"$out/$1" 2>"$out/said" || status=$?
  ((status == 0)) && judged "$out/$1" "$2" "$3" "$4" && return
  complain "$1: status $status: $(cat "$out/said")"
}

# apart ACCOUNTING FOLDER MOST_US FEW: on two robots, 5 ms from each other.
apart() {
  local status=0 command
  command=$(printf '"%s", ' "${program[@]}")
  cat >"$out/scenario.yaml" <<END
duration: 1h
network: {latency: 5ms}
robots:
  receiver: {clients: {program: {command: [$command receive, "$at_receiver", "$count"]}}}
  sender: {clients: {program: {command: [$command send, "$at_sender", "$count"]}}}
END
  timeout 250 "$build/bin/tcsim" run "$out/scenario.yaml" --accounting "$1" --out "$out/$2" >"$out/said" 2>&1 || status=$?
  ((status == 0)) && judged "$out/$2/receiver-program.out.log" 5000 "$3" "$4" && return
  complain "$2: status $status: $(cat "$out/said" "$out/$2"/*.err.log)"
}

case $variant in
  native)
    # In real time, on a machine that others use, too: how late messages are says nothing.
    steadily "$build" here natively 0 30000000 0
    ;;
  exec)
    here measured 0 2000 5 "$build/bin/tcsim" exec --
    for run in first second; do here $run 0 500 0 "$build/bin/tcsim" exec --accounting fixed --; done
    $repeats || exit 0
    cmp "$out/first" "$out/second" || complain "fixed runs differ"
    ;;
  network)
    "$here/../scenario/can_have_networks.sh" || exit 77
    apart measured measured 7000 5
    for run in first second; do apart fixed $run 5500 0; done
    $repeats || exit 0
    for file in trace.json dispatches.csv receiver-program.out.log; do
      cmp "$out/first/$file" "$out/second/$file" || complain "$file of fixed runs differs"
    done
    ;;
esac
