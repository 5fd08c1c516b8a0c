#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The predator's programs are Cyclone DDS programs like any other: natively, over the real network,
# they find a robot and each other, plan, and follow their plans.
# Topics: examples, dds.
export CYCLONEDDS_URI='<CycloneDDS><Domain id="any"><General><Interfaces>
  <NetworkInterface name="lo" multicast="true"/></Interfaces></General></Domain></CycloneDDS>'
example=$build/examples/predator_prey
out=$(mktemp -d)
# Nobody else's topics, whatever else runs on this machine.
names=(--domain 87 --namespace "predator_$$")
started=()
stop() { for pid in "$@"; do kill "$pid" && wait "$pid" || true; done 2>/dev/null; }
trap 'stop "${started[@]}"; rm -rf "$out"' EXIT

start() { "${@:2}" "${names[@]}" >>"$out/$1" 2>&1 & started+=($!); last=$!; }
fly() {
  start robot "$build/bin/predator_robot" --prey-namespace "prey_$$" --plans "$1" --patience 100
  local robot=$last
  start planner "$example/predator_planner" --budget 0.2
  wait "$robot" || fail "$(tail "$out"/*)"
  stop "$last"
}
start controller "$example/predator_controller" --prey-namespace "prey_$$" --request-timeout 1 --kp 0 --kd 0
fly 3
fly 2  # the controller goes on with another planner, and another robot
[[ $(grep -c 'commands to coast' "$out/robot") == 2 ]] || fail "$(cat "$out/robot")"
grep -q 'plan 3: [0-9.]* s, [0-9]* states' "$out/planner" || fail "$(cat "$out/planner")"
stop "${started[@]}"
started=()

# In virtual time they do the same, and a plan takes what it takes: three of 0.2 s, two of which are
# executed for 0.1 s, the third for three commands, and a little for finding each other and for
# waiting for ticks.
cat >"$out/all" <<END
date +%s%N
$build/bin/predator_robot ${names[*]} --plans 3 & robot=\$!
$example/predator_controller ${names[*]} --kp 0 --kd 0 & controller=\$!
$example/predator_planner ${names[*]} --budget 0.2 2>>$out/planner & planner=\$!
wait \$robot || exit
date +%s%N
kill \$controller \$planner
END
for transport in endpoints sockets; do
  "$tcsim" exec --dds "$transport" --accounting fixed -- bash "$out/all" >"$out/said" 2>"$out/errors" ||
    fail "by $transport: $(cat "$out/said" "$out/errors")"
  [[ $(sed -n 2p "$out/said") == '3 plans asked for, 3 followed, '* ]] || fail "by $transport: $(cat "$out/said")"
  took_ms=$((($(sed -n 3p "$out/said") - $(sed -n 1p "$out/said")) / 1000000))
  ((took_ms >= 820 && took_ms < 1100)) ||
    fail "three plans by $transport took $took_ms ms: $(cat "$out/said" "$out/errors")"
done
