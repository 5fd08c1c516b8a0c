#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What is sent to any address of this computer is received by whoever listens at that port of all of them, and counted as its; what goes
# to many, or elsewhere, is not said to have met nobody. What is sent to where nobody listens is.
# Topics: udp, failures.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/listens.py" <<'PY'
import socket, sys
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
s.bind((sys.argv[1], 27651))
while True: s.recv(100)
PY
cat >"$out/sends.py" <<'PY'
import socket, time
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
time.sleep(0.1)
for _ in range(20):
    for to in ("127.0.0.1", 27651), ("127.0.0.2", 27651), ("127.0.0.3", 27651), ("127.0.0.1", 27652), ("239.255.0.7", 27653):
        try: s.sendto(b"x", to)
        except ConnectionRefusedError: pass  # what was sent before met nobody
    time.sleep(0.01)
PY
cat >"$out/s.yaml" <<'YAML'
duration: 2s
robots:
  r:
    clients:
      all: {command: [python3, listens.py, 0.0.0.0]}
      one: {command: [python3, listens.py, 127.0.0.3]}
      sender: {command: [python3, sends.py], start: 1s}
YAML
for accounting in measured fixed; do
  timeout 200 "$tcsim" run "$out/s.yaml" --accounting "$accounting" --out "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  python3 - "$out/run/summary.json" <<'PY' || fail "$accounting: $(cat "$out/said")"
import json, sys
summary = json.load(open(sys.argv[1]))
def inputs(client): return [(i["from"], i["sent"], i["received"], i["lost"]) for i in summary["clients"][client]["inputs"]]
assert inputs("r/all") == [("r/sender over UDP port 27651", 40, 40, 0)], inputs("r/all")
# What came before its first read is not known to be its.
(_, sent, received, lost), = inputs("r/one")
assert 19 <= sent == received <= 20 and lost == 0, inputs("r/one")
unheard = [line for line in summary["verdict"] if "nobody received any" in line]
assert len(unheard) == 1 and unheard[0].startswith("r/sender sent "), unheard
assert "UDP port 27652" in unheard[0] and "r/one at UDP port 27651" in unheard[0], unheard
PY
done
