#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Three nodes on one core that are asked to end in the midst of their talk end as soon as natively: by endpoints at once, by sockets after
# the 0.2 s in which Cyclone DDS tells others that it goes; also nodes of three robots with a network between them.
build_nodes
out=$(mktemp -d)
trap 'wait; rm -rf "$out"' EXIT
use_folder "$out"
cat >"$out/s.yaml" <<YAML
duration: 2s
robots:
  r:
    clients:
      talker: {command: [$nodes/talk, talker, "100000", "1000"]}
      one: {command: [$nodes/talk, listener, "100000"]}
      two: {command: [$nodes/talk, listener, "100000"]}
YAML
cat >"$out/three.yaml" <<YAML
duration: 2s
network: {latency: 5ms}
robots:
  a: {clients: {talker: {command: [$nodes/talk, talker, "100000", "10000"]}}}
  b: {clients: {one: {command: [$nodes/talk, listener, "100000"]}}}
  c: {clients: {two: {command: [$nodes/talk, listener, "100000"]}}}
YAML
ends_in() {  # GRACE SCENARIO DDS OPTIONS...
  local grace=$1 scenario=$2 dds=$3
  shift 3
  sed "s/\]}/], dds: $dds, stop_grace: $grace}/" "$out/$scenario" >"$out/run.yaml"
  timeout 300 "$tcsim" run "$out/run.yaml" "$@" --out "$out/run" >"$out/said" 2>&1 || fail "$scenario, $dds, $*: $(cat "$out/said" "$out"/run/*.log)"
  ! grep 'was killed' "$out/said" || fail "$scenario, $dds, $*: not within $grace"
}
for accounting in measured fixed; do
  for scenario in s.yaml three.yaml; do
    ends_in 300ms "$scenario" sockets --accounting "$accounting"
    ends_in 60ms "$scenario" endpoints --accounting "$accounting"
  done
done
