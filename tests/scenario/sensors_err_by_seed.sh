#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Sensors say what a body feels, with the errors that the scenario gives them: the same ones for the same seed, whoever else
# runs; commands are held to their limits.
# Topics: sensors, commands, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/log.py" <<'PY'
import socket, sys, time
sensors = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
sensors.bind(("127.0.0.1", 27471))
socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(b'{"force": [5, 0, 9.8], "torque": [0, 0, 1]}', ("127.0.0.1", 27472))
while True:
    text = sensors.recv(4096).decode()
    print(time.monotonic() - 1000, text, flush=True)
PY
cat >"$out/s.yaml" <<'YAML'
duration: 2s
dynamics: {gravity: [0, 0, -9.8]}
bodies: {ship: {mass: 1, inertia: [1, 1, 1], orientation: [0, 0, 0.7071067811865476, 0.7071067811865476]}}
robots:
  r: {clients: {c: {command: [python3, log.py], body: ship, fixed_allocation_cost: 0s}}}
channels:
  imu:
    type: udp_json
    sensors: {bodies: [ship], rate: 100, fields: [angular_rate, proper_acceleration], to: "127.0.0.1:27471"}
  thrust: {type: udp_json, commands: {body: ship, limits: {force: [2, 2, 20], torque: 0.5}, listen: "127.0.0.1:27472"}}
YAML
run() {  # NAME ARGUMENTS...
  local name=$1
  shift
  "$tcsim" run "$out/s.yaml" --accounting fixed --out "$out/$name" "$@" >"$out/said" 2>&1 || fail "$name: $(cat "$out/said")"
}
noisy=(--set 'channels.imu.sensors.noise={proper_acceleration: 0.05, angular_rate: 0.01}'
       --set 'channels.imu.sensors.bias={angular_rate: [0, 0, 0.1]}'
       --set channels.imu.sensors.dropout=0.2 --set channels.imu.sensors.jitter=8ms)
other=(--set 'robots.q={clients: {c: {command: [python3, -c, "import time\nwhile True: time.sleep(0.0007)"]}}}')
run exact
run noisy "${noisy[@]}"
run again "${noisy[@]}"
run seeded "${noisy[@]}" --seed 2
run beside "${noisy[@]}" "${other[@]}"
cmp "$out/noisy/r-c.out.log" "$out/again/r-c.out.log" || fail "two runs with the same seed differ"
! cmp -s "$out/noisy/r-c.out.log" "$out/seeded/r-c.out.log" || fail "another seed makes no difference"
python3 - "$out" <<'PY' || fail "$(head -3 "$out/exact/r-c.out.log")"
import json, statistics, sys
def lines(run):
    found = []
    for line in open(f"{sys.argv[1]}/{run}/r-c.out.log"):
        at, text = line.split(" ", 1)
        reading = json.loads(text)
        found.append((float(at), reading["time"], reading["bodies"]["ship"]))
    return [x for x in found if x[1] > 0.5]
for at, time, ship in lines("exact"):
    # 2 N of the 5 on 1 kg, seen along the axes of a ship that turns by 0.5 N m on 1 kg m2; and what holds it up.
    x, y, z = ship["proper_acceleration"]
    assert set(ship) == {"angular_rate", "proper_acceleration"}, ship
    assert abs((x * x + y * y) ** 0.5 - 2) < 1e-3 and abs(z - 9.8) < 1e-6, ship
    rates = ship["angular_rate"]
    assert abs(rates[2] - 0.5 * time) < 0.1 and abs(rates[0]) < 1e-9, (time, rates)
exact = {time: ship for at, time, ship in lines("exact")}
noisy = lines("noisy")
assert 0.6 * len(exact) < len(noisy) < 0.95 * len(exact), (len(noisy), len(exact))
late = [at - time for at, time, ship in noisy]
assert 0 <= min(late) and 0.006 < max(late) < 0.0085 and [time for at, time, ship in noisy] == sorted(t for a, t, s in noisy)
errors = [ship["proper_acceleration"][2] - 9.8 for at, time, ship in noisy]
assert 0.03 < statistics.stdev(errors) < 0.07 and abs(statistics.mean(errors)) < 0.02
bias = statistics.mean(ship["angular_rate"][2] - exact[time]["angular_rate"][2] for at, time, ship in noisy)
assert abs(bias - 0.1) < 0.01, bias
# Beside another robot the times of the program may differ, but not what the sensor does.
beside = {time: ship["proper_acceleration"][2] for at, time, ship in lines("beside")}
assert beside.keys() == {time for at, time, ship in noisy}
assert all(abs(beside[time] - ship["proper_acceleration"][2]) < 1e-9 for at, time, ship in noisy)
PY
"$tcsim" run "$out/s.yaml" --set channels.imu.sensors.noise.speed=1 >"$out/said" 2>&1 && fail "an unknown field was taken"
grep -q "unknown key 'speed' in channels.imu.sensors.noise" "$out/said" || fail "$(cat "$out/said")"
