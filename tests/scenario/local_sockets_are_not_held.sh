#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Who looks into a socket that only its own robot's programs, and sensors, can send to, or sends there, does not wait for
# other robots: a tick of a loop is one dispatch, though other robots tick, too. And from another robot's first
# datagram on, whichever way it is sent, nothing is seen too late: it counts as sent when the socket was last looked into.
# Topics: scheduling, unix sockets, network.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/ticks.py" <<'PY'
# NAME TICKS: a thousand times a second sends to a socket of its own robot, and looks into two.
import socket, sys, time
name, ticks = sys.argv[1], int(sys.argv[2])
def receiver(name):
    s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    s.bind("\0tcs-test-" + name)
    s.setblocking(False)
    return s
sockets = [receiver(name + "/a"), receiver(name + "/b")]
begin = time.clock_gettime_ns(time.CLOCK_MONOTONIC) // 10**6 * 10**6 + 10**7
for tick in range(ticks):
    time.sleep((begin + tick * 10**6 - time.clock_gettime_ns(time.CLOCK_MONOTONIC)) / 1e9)
    sockets[0].sendto(b"tick", "\0tcs-test-" + name + "/b")
    for s in sockets:
        try:
            s.recv(100)
        except BlockingIOError:
            pass
PY
cat >"$out/look.py" <<'PY'
# WAY: looks on and on, and says twice when it had last looked in vain before it found something.
import socket, sys, time
s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
s.bind("\0tcs-test-looked-into-" + sys.argv[1])
s.setblocking(False)
now = lambda: time.clock_gettime_ns(time.CLOCK_MONOTONIC)
in_vain = looks = found = 0
while found < 2:
    at = now()
    try:
        text = s.recv(100).decode()
    except BlockingIOError:
        in_vain, looks = at, looks + 1
        continue
    print(text, in_vain, now(), looks, flush=True)
    found += 1
PY
cat >"$out/send.py" <<'PY'
# WAY: sends twice from another robot, and says when each call began and ended.
import ctypes, socket, sys, time
way = sys.argv[1]
name = b"\0tcs-test-looked-into-" + way.encode()
now = lambda: time.clock_gettime_ns(time.CLOCK_MONOTONIC)
libc = ctypes.CDLL(None, use_errno=True)
s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
address = (1).to_bytes(2, "little") + name
def raw(text):
    sent = libc.syscall(44, s.fileno(), text, len(text), 0, address, len(address))  # sendto
    assert sent == len(text), ctypes.get_errno()
connected = False
def send(text):
    global connected
    if way == "connect":
        if not connected: s.connect(name)
        connected = True
        s.send(text)
    elif way == "sendto": s.sendto(text, name)
    elif way == "sendmsg": s.sendmsg([text], [], 0, name)
    elif way == "raw": raw(text)
for number, delay in enumerate((0.1205, 0.0203)):
    time.sleep(delay)
    began = now()
    send(str(number).encode())
    print(number, began, now(), flush=True)
PY
dispatches_of() {  # TICKS [NAMES [NETWORK]]: what the sockets of each robot are called
  local names=(${2:-a b c})
  cat >"$out/ticks.yaml" <<YAML
duration: 1s
${3:-}
robots:
  a: {clients: {c: {command: [python3, ticks.py, ${names[0]}, "$1"]}}}
  b: {clients: {c: {command: [python3, ticks.py, ${names[1]}, "$1"]}}}
  c: {clients: {c: {command: [python3, ticks.py, ${names[2]}, "$1"]}}}
YAML
  "$tcsim" run "$out/ticks.yaml" --accounting fixed --out "$out/run" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
  sed -n 's/^ *"dispatches": \([0-9]*\).*/\1/p' "$out/run/summary.json"
}
# What the interpreters' starts take is in both.
few=$(dispatches_of 100) many=$(dispatches_of 500)
((many - few < 1300)) || fail "1200 ticks took $((many - few)) dispatches"
# Where each robot is a host of its own, one name is another socket on each: all stay local.
if "$source_root/tests/scenario/can_have_networks.sh"; then
  few=$(dispatches_of 100 "x x x" "network: {}") many=$(dispatches_of 500 "x x x" "network: {}")
  ((many - few < 1300)) || fail "with one name on three hosts 1200 ticks took $((many - few)) dispatches"
fi

ways=(sendto connect sendmsg raw)
{
  echo "duration: 2s"  # they end before
  echo "robots:"
  for way in "${ways[@]}"; do
    echo "  looker-$way: {clients: {c: {command: [python3, look.py, $way]}}}"
    echo "  sender-$way: {clients: {c: {command: [python3, send.py, $way]}}}"
  done
} >"$out/ways.yaml"
for accounting in fixed measured; do
  "$tcsim" run "$out/ways.yaml" --accounting $accounting --out "$out/run" >"$out/said" 2>&1 || fail "$accounting: $(cat "$out/said")"
  python3 - "$out/run" $accounting "${ways[@]}" <<'PY' || fail "$accounting: $(cat "$out/run"/*.log "$out/said")"
import json, sys
run, accounting, ways = sys.argv[1], sys.argv[2], sys.argv[3:]
read = lambda name: [tuple(map(int, line.split())) for line in open(f"{run}/{name}-c.out.log")]
for way in ways:
    sent, seen = read("sender-" + way), read("looker-" + way)
    assert len(sent) == len(seen) == 2, (way, sent, seen)
    for (number, began, ended), (found, in_vain, at, looks) in zip(sent, seen):
        assert number == found
        assert in_vain <= ended, f"{way}, {number}: looked in vain at {in_vain}, sent by {ended}"
        assert began <= at, f"{way}, {number}: sent at {began}, found at {at}"
    # And what the call itself computes, which is the host's where it is measured.
    most = 1_100_000 if accounting == "fixed" else 2_000_000
    assert sent[0][2] - sent[0][1] <= most, f"{way}: more than the drift bound: {sent[0]}"
    assert seen[0][3] > 100, f"{way}: it has not looked before"
assert json.load(open(run + "/summary.json"))["staleness_ns"] == 0
PY
done
