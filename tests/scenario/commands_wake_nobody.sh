#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What a program sends to the world by UNIX and UDP datagrams goes through its command ring: neither is the program stopped for
# it, nor does tcsim wake. It acts when it was sent, as what the kernel carries, whatever call has sent it, and in the same
# order, also where the kernel carries some of it. What cannot be sent fails as it does natively.
# Topics: commands, udp, unix sockets, scheduling, containers.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
contained=0
[[ ${3:-} != in_container ]] || contained=1
scenario() {  # TYPE ADDRESS WAY COUNT [NETWORK]
  cat <<YAML
duration: 0.6s
${5:-}
dynamics: {}
bodies: {ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
robots:
  r:
    clients:
      c:
        command: ["$build/bin/commander", $1, "$2", $3, "$4", "50"]
        fixed_call_cost: 1ns
        fixed_allocation_cost: 0s
channels:
  hands: {type: $1_json, commands: {body: ship, listen: "$2"}}
YAML
}
run() {  # FOLDER OPTIONS...: of the scenario there
  "$tcsim" run "$out/$1.yaml" --out "$out/$1" "${@:2}" >"$out/$1.said" 2>&1 || fail "$1: $(cat "$out/$1.said")"
  ! grep -q warning "$out/$1.said" || fail "$1: $(cat "$out/$1.said")"
}
# The commands, each at the tick at which it was sent: a call takes a nanosecond.
ticks_of() { sed -E 's/^([0-9]*)[0-9]{4},[0-9]*,/\1,/' "$out/$1/commands.csv"; }
# Whether they act as those of the other run: by the nanosecond where as many calls have sent them.
act_alike() {  # NAME OTHER
  diff <(ticks_of "$2") <(ticks_of "$1") >"$out/$1.differ" || fail "$1: other commands than $2: $(head -5 "$out/$1.differ")"
  case $1 in *sendmmsg*|*child*|*thread*) return ;; esac
  cmp "$out/$2/commands.csv" "$out/$1/commands.csv" || fail "$1: commands at other times than $2"
  cmp "$out/$2/bodies.csv" "$out/$1/bodies.csv" || fail "$1: another flight than $2"
}
unix='@${run}/hands' udp=127.0.0.1:27493
ways="send sendto sendmsg sendmmsg child thread long long_sendmmsg beside"
((!contained)) || ways="sendto sendmmsg thread long_sendmmsg"
send_each_way() {  # TYPE
  local type=$1 count rows way name
  for count in 2 40; do  # 40 are more than a command ring takes
    scenario $type "${!type}" write $count >"$out/$type$count.yaml"
    run $type$count --accounting fixed
    rows=$(wc -l <"$out/$type$count/commands.csv")
    ((rows == 50 * count * 6 + 1)) || fail "$type, $count: $rows lines of commands"
  done
  for way in $ways; do
    for count in 2 40; do
      [[ $way == child && $count == 40 ]] && continue
      name=$type-$way-$count
      scenario $type "${!type}" $way $count >"$out/$name.yaml"
      run $name --accounting fixed
      act_alike $name $type$count
    done
  done
}
beside send_each_way unix
send_each_way udp
all_done
cmp "$out/unix2/commands.csv" "$out/udp2/commands.csv" || fail "UNIX and UDP differ"

# Each command that the kernel carries stops the program and wakes tcsim, where these have priorities.
figure() { sed -n "s/.*$2 \([0-9]*\).*/\1/p" "$out/$1/r-c.out.log"; }
spares() {  # NAME OTHER AT_LEAST: of both figures
  local what less more
  for what in stops sleeps; do
    less=$(figure "$1" $what) more=$(figure "$2" $what)
    ((more - less >= $3)) || fail "$1: $what $less, and $more with $2"
  done
}
for type in unix udp; do
  if ((!contained)) && chrt -f 10 true 2>/dev/null; then
    # Of 90; the host may stop the program, and have tcsim look, a few times besides.
    for way in send sendto sendmsg sendmmsg; do spares $type-$way-2 ${type}2 60; done
  fi
  # With rights or without them, and whichever time it is that passes: all of them come, in order.
  for options in "--accounting measured" "--accounting fixed --sync callback"; do
    for way in sendto long_sendmmsg; do
      # shellcheck disable=SC2086
      run $type-$way-2 $options
      cut -d, -f3- "$out/$type-$way-2/commands.csv" | cmp - <(cut -d, -f3- "$out/${type}2/commands.csv") ||
        fail "$type, $way, $options: other commands than with write"
    done
  done
done

# Recorded, all are known to have come, and from whom.
run unix-sendto-2 --accounting fixed --record mcap
run unix2 --accounting fixed --record mcap
cmp "$out/unix2/datagrams.csv" "$out/unix-sendto-2/datagrams.csv" || fail "other datagrams than by write"
(($(wc -l <"$out/unix2/datagrams.csv") == 101)) || fail "$(head -3 "$out/unix2/datagrams.csv")"

# Where robots are hosts of their own the kernel carries all.
if ((!contained)) && "$source_root/tests/scenario/can_have_networks.sh"; then
  scenario udp 10.42.0.1:27493 sendto 2 "network: {}" >"$out/network.yaml"
  run network --accounting fixed
  act_alike network udp2
fi

# Errors.
for type in unix udp; do
  scenario $type "${!type}" errors "" >"$out/errors.yaml"
  "$tcsim" run "$out/errors.yaml" --out "$out/errors" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  address=@tcs-test-natively-$$  # a short one is refused otherwise: a number may have few digits
  [[ $type == unix ]] || address=127.0.0.1:27494
  "$build/bin/commander" $type "$address" errors own >"$out/native" || fail "natively: $(cat "$out/native")"
  diff "$out/native" "$out/errors/r-c.out.log" || fail "$type: other errors than natively"
done
