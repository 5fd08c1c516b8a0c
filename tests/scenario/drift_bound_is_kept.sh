#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Robots that talk over TCP and compute in between, without a world: whenever the kernel hands over
# what one of them sent, nobody comes further apart than the drift bound.
# Topics: drift, tcp.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/peer.py" <<'PY'
import socket, sys, time
role, port = sys.argv[1], int(sys.argv[2])
def compute(rounds):
    total = 0
    for i in range(rounds): total += i
    return total
if role == "listen":
    listener = socket.create_server(("127.0.0.1", port))
    peer, _ = listener.accept()
    while data := peer.recv(100): print(time.monotonic(), data.decode(), flush=True)
else:
    time.sleep(0.5)  # the other one listens by then, whatever a busy host has charged to it
    peer = socket.create_connection(("127.0.0.1", port))
    for i in range(5):
        peer.send(b"x")
        peer.send(b"y")
        print(time.monotonic(), flush=True)
        compute(1_000_000)
PY
cat >"$out/scenario.yaml" <<'YAML'
duration: 3s
robots:
  one: {clients: {listener: {command: [python3, peer.py, listen, "27434"]}}}
  other: {clients: {speaker: {command: [python3, peer.py, speak, "27434"]}}}
YAML
for bound in 0.1ms 1ms; do
  "$tcsim" run "$out/scenario.yaml" --drift "$bound" --out "$out/run" >"$out/said" 2>&1 ||
    fail "$(cat "$out/said")"
  python3 - "$out/run" <<'PY' || fail "$bound: $(cat "$out/said")"
import json, sys
summary = json.load(open(sys.argv[1] + "/summary.json"))
heard = open(sys.argv[1] + "/one-listener.out.log").read().split()[1::2]
assert "".join(heard) == 5 * "xy", heard
assert 0 < summary["drift_ns"] <= summary["drift_bound_ns"], summary["drift_ns"]
PY
done
