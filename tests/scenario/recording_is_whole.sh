#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The recording of a whole run is a bag as ROS 2 reads it: the database is in order, metadata.yaml
# counts what is in it, all messages can be read, and say what was written, at its virtual time.
# Topics: recording, ros, determinism.
out=$(mktemp -d)
run=
trap '[[ -z $run ]] || kill -9 "$run" 2>/dev/null || true; rm -rf "$out"' EXIT
check() { python3 "$(dirname -- "${BASH_SOURCE[0]}")/recording.py" "$@" || fail "$(cat "$out/said")"; }

# The example, twice: the same rows. Its ports may be somebody else's on this host.
for i in first second; do
  "$build/bin/in_own_network" "$tcsim" run "$build/examples/predator_prey/scenario.yaml" --set 'clock={}' \
    --accounting fixed --duration 1.2s --record --out "$out/$i" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
done
check example "$out/first"
check same "$out/first" "$out/second"

# A program that says what it read and wrote, in measured time; among it what nobody else reads, and
# is for late readers, and of another domain.
cat >"$out/scenario.yaml" <<YAML
duration: 2s  # the witness ends after 0.9 s and what it computes
dynamics: {gravity: [0, 0, -9.81]}
bodies: {ship: {mass: 2, inertia: [0.1, 0.2, 0.25], angular_velocity: [0.3, 0.2, 0.1]}}
robots: {r: {clients: {witness: {command: ["$build/bin/bag_witness", "90"], body: ship}}}}
clock: {}
channels:
  odometry:
    {type: dds, sensors: {bodies: [ship], message: nav_msgs/Odometry, topic: /odom, latency: 5ms, qos: {deadline: 20ms}}}
  joints: {type: dds, sensors: {bodies: [ship], message: sensor_msgs/JointState, topic: /joints, qos: {lifespan: 1s}}}
  wrench: {type: dds, commands: {body: ship, message: geometry_msgs/Wrench, topic: /wrench}}
YAML
"$tcsim" run "$out/scenario.yaml" --record --out "$out/told" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
check witness "$out/told" "$out/told/r-witness.out.log"

# What was recorded until the coordinator was killed can be read.
"$tcsim" run "$out/scenario.yaml" --duration 1h --set robots.r.clients.witness.command.1=1000000 \
  --record --out "$out/killed" >"$out/said" 2>&1 &
run=$!
kill_once_recorded "$run" "$out/killed/bag" 500
run=
check cut-off "$out/killed"
