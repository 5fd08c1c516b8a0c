#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Two DDS programs that are made like ROS 2's nodes: fixed runs write the same bytes, and what DDS
# numbers at random is the same (handles, instances, GUIDs), by endpoints and by sockets. Programs of
# one run have others, and by sockets runs of another seed.
# Topics: determinism, dds, ros.
# In a network of their own: by sockets they would meet other tests' programs, whose messages take time, too.
export CYCLONEDDS_URI='<CycloneDDS><Domain id="any"><General><Interfaces>
  <NetworkInterface name="lo" multicast="true"/></Interfaces></General></Domain></CycloneDDS>'
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
fly() {  # NAME CARRIED OPTION...
  cat >"$out/scenario.yaml" <<YAML
duration: 5s
robots:
  robot:
    clients:
      listener: {command: ["$build/bin/rmw_pair", listener, "20"], dds: $2}
      talker: {command: ["$build/bin/rmw_pair", talker, "20"], dds: $2}
YAML
  "$build/bin/in_own_network" "$tcsim" run "$out/scenario.yaml" --accounting fixed --out "$out/$1" "${@:3}" \
    >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  (($(grep -c ' at .* from ' "$out/$1/robot-listener.out.log") == 20)) || fail "$1: samples are missing"
  [[ -z $(guids "$1" | uniq -d) ]] || fail "$1: two entities have one GUID: $(guids "$1" | uniq -d)"
}
guids() { grep -ho 'GUID .*' "$out/$1"/robot-*.out.log | sort; }
for carried in endpoints sockets; do
  for run in first second; do fly "$run" "$carried"; done
  for file in robot-listener.out.log robot-talker.out.log output.csv trace.json activations.csv dispatches.csv; do
    cmp "$out/first/$file" "$out/second/$file" || fail "$carried: $file differs"
  done
done
# Those of processes that come and go in shared memory are theirs alone; all others are drawn.
fly other sockets --set seed=2
[[ $(guids first) != "$(guids other)" ]] || fail "another seed has the same GUIDs"
