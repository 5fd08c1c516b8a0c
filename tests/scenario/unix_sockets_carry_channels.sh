#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A controller on UNIX sockets flies as it does on UDP, to the byte; the socket's file is gone after the run, also
# after one that was killed, and what is in its way is named.
# Topics: unix sockets, udp, clean-up, containers.
out=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$out"' EXIT
cat >"$out/client.py" <<'PY'
import json, socket, sys
family = {"unix": socket.AF_UNIX, "udp": socket.AF_INET}[sys.argv[1]]
name = lambda text: text if family == socket.AF_UNIX else ("127.0.0.1", int(text))
sensors = socket.socket(family, socket.SOCK_DGRAM)
sensors.bind("\0" + sys.argv[2][1:] if sys.argv[2][0] == "@" else name(sys.argv[2]))
commands = socket.socket(family, socket.SOCK_DGRAM)
commands.connect(name(sys.argv[3]))
while True:
    body = json.loads(sensors.recv(4096))["bodies"]["ship"]
    force = [4 * (1 - p) - 4 * v for p, v in zip(body["position"], body["linear_velocity"])]
    commands.send(json.dumps({"force": force}).encode())
PY
scenario() {  # TYPE SENSORS COMMANDS
  cat <<YAML
duration: 2s
dynamics: {}
bodies: {ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
robots:
  r: {clients: {c: {command: [python3, client.py, ${1%_json}, "${4:-${2##*:}}", "${3##*:}"], body: ship, fixed_allocation_cost: 0s}}}
channels:
  eyes: {type: $1, sensors: {bodies: [ship], rate: 100, latency: 3ms, to: "$2"}}
  hands: {type: $1, commands: {body: ship, latency: 1ms, listen: "$3"}}
YAML
}
scenario udp_json 127.0.0.1:27461 127.0.0.1:27462 >"$out/udp.yaml"
scenario unix_json eyes.sock hands.sock >"$out/unix.yaml"
scenario unix_json @tcs-test-eyes '${result_dir}/h.sock' >"$out/named.yaml"
for name in udp unix named; do
  "$tcsim" run "$out/$name.yaml" --accounting fixed --out "$out/$name" >"$out/said" 2>&1 || fail "$name: $(cat "$out/said")"
  ! grep -q 'warning' "$out/said" || fail "$name: $(cat "$out/said")"
done
rm "$out/eyes.sock"  # that is the client's
cmp "$out/udp/bodies.csv" "$out/unix/bodies.csv" || fail "on UNIX sockets the ship flies otherwise than on UDP"
cmp "$out/udp/bodies.csv" "$out/named/bodies.csv" || fail "with an abstract name the ship flies otherwise"
grep -q '^1.990000000,ship,0.9' "$out/unix/bodies.csv" || fail "the ship has not come near 1 m: $(tail -1 "$out/unix/bodies.csv")"
[[ ! -e $out/hands.sock && ! -e $out/named/h.sock ]] || fail "the run has left its socket"

run() { "$tcsim" run "$out/unix.yaml" --out "$out/run" >"$out/said" 2>&1; }
# One that is killed.
rm -f "$out/eyes.sock"
"$tcsim" run "$out/unix.yaml" --set duration=1h --out "$out/killed" >"$out/said" 2>&1 &
# It may have to wait for a processor, for which it has its socket by then.
for _ in $(seq 1000); do [[ -S $out/hands.sock && -s $out/killed/bodies.csv ]] && break; sleep 0.1; done
[[ -S $out/hands.sock ]] || fail "the run has made no socket"
kill -KILL "$(coordinator_of $!)"
wait $! || true
[[ ! -e $out/hands.sock ]] || fail "a killed run has left its socket"

# What nobody has open any more is replaced.
rm -f "$out/eyes.sock"
python3 -c 'import socket, sys; socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM).bind(sys.argv[1])' "$out/hands.sock"
run || fail "a stale socket: $(cat "$out/said")"

refused() {  # PATTERN ARGUMENTS...
  local pattern=$1 status=0
  shift
  rm -f "$out/eyes.sock"
  "$tcsim" run "$out/unix.yaml" --out "$out/run" "$@" >"$out/said" 2>&1 || status=$?
  ((status == 2)) && [[ $(wc -l <"$out/said") == 1 ]] && grep -q "$pattern" "$out/said" || fail "status $status: $(cat "$out/said")"
}
touch "$out/file"
refused "'$out/file' exists and is not a socket" --set channels.hands.commands.listen=file
[[ -f $out/file ]] || fail "a file that was in the way was removed"
refused "'$out/nowhere/s' cannot be made because its folder does not exist; make the folder" --set channels.hands.commands.listen=nowhere/s
refused "longer than a UNIX socket's name may be (107 bytes)" --set "channels.hands.commands.listen=$(printf '%0110d' 0)"
python3 -c '
import socket, sys, time
s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM); s.bind(sys.argv[1])
print("bound", flush=True); time.sleep(200)' "$out/hands.sock" >"$out/holder" &
for _ in $(seq 1200); do grep -q bound "$out/holder" && break; sleep 0.05; done
refused "'$out/hands.sock' is taken by another program; end that program, or choose another path"
[[ -S $out/hands.sock ]] || fail "a socket that another program has was removed"

# Nobody listens, and nobody commands.
rm "$out/hands.sock"
"$tcsim" run "$out/unix.yaml" --set 'robots.r.clients.c.command=[sleep, "3"]' --out "$out/run" >"$out/said" 2>&1 || true
grep -q "channel eyes: no program has bound the UNIX socket $out/eyes.sock, so the samples for it are lost; let a client bind it" "$out/said" || fail "$(cat "$out/said")"
grep -q "channel hands: nothing came in on the UNIX socket $out/hands.sock, so no command moved ship" "$out/said" || fail "$(cat "$out/said")"
