#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A planner whose next message is always there already never waits, and has an activation for each
# message all the same, however it receives. Those that wait have no more than before: neither for what
# they receive in one go, nor for several messages of one period.
# Topics: activations, udp.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
python=$(python3 -c 'import sys; print(sys.executable)')  # python3 may be a script that runs it
cat >"$out/client.py" <<'PY'
import ctypes, os, select, socket, struct, sys, time

COUNT = 30
PERIOD = 0.01
PORTS = {"blocking": 27601, "polling": 27602, "selecting": 27603, "raw": 27604, "waiting": 27605,
         "periodic": 27606, "draining": 27607, "server": 27608}
libc = ctypes.CDLL(None, use_errno=True)
kind = sys.argv[1]

def compute(seconds):
    end = time.thread_time() + seconds
    while time.thread_time() < end: pass

def listen(port):
    s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    s.bind(("127.0.0.1", port))
    return s

def begin():  # of the run's clock
    time.sleep(max(0, 1000.5 - time.monotonic()))

if kind == "source":
    s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    begin()
    for i in range(COUNT):
        for name, port in PORTS.items():
            for further in range(3 if name in ("periodic", "draining") else 1):
                s.sendto(b"x" * 10, ("127.0.0.1", port))
        time.sleep(PERIOD)
elif kind == "timer":  # read late each time
    fd = libc.timerfd_create(1, 0)
    libc.timerfd_settime(fd, 0, struct.pack("qqqq", 0, 10_000_000, 0, 10_000_000), None)
    for i in range(COUNT):
        os.read(fd, 8)
        compute(0.015)
else:
    s = listen(PORTS[kind])
    took = 0
    buffer = ctypes.create_string_buffer(100)
    if kind == "periodic":
        begin()
        due = time.monotonic() + 5 * PERIOD / 2  # the source's periods are longer by what it takes to send, on any host
    while took < (3 * COUNT if kind in ("periodic", "draining") else COUNT):
        if kind == "blocking":
            s.recv(100)
        elif kind == "selecting":
            select.select([s], [], [])
            s.recv(100)
        elif kind == "polling":
            try: s.recv(100, socket.MSG_DONTWAIT)
            except BlockingIOError: continue
        elif kind == "raw":
            assert libc.syscall(45, s.fileno(), buffer, 100, 0, None, None) == 10
        elif kind in ("waiting", "server"):
            s.recv(100)
        elif kind == "draining":
            select.select([s], [], [])
            try:
                while True:
                    s.recv(100, socket.MSG_DONTWAIT)
                    took += 1
            except BlockingIOError: pass
            compute(0.002)
            continue
        elif kind == "periodic":  # three messages, two calls that would wait, an answer
            due += PERIOD
            time.sleep(max(0, due - time.monotonic()))
            for i in range(3): s.recv(100)
            took += 3
            compute(0.002)
            s.sendto(b"", ("127.0.0.1", 27600))
            continue
        took += 1
        if kind == "server":  # it answers at once, and has to do but little
            s.sendto(b"", ("127.0.0.1", 27600))
            if took % 3 == 1: time.sleep(3 * PERIOD)
        else:
            compute(0.002 if kind == "waiting" else 0.015)
print("done", flush=True)
PY
kinds=(blocking polling selecting raw waiting periodic draining server timer)
{
  echo "duration: 3s"
  echo "robots:"
  for kind in source "${kinds[@]}"; do
    echo "  $kind: {clients: {c: {command: [$python, client.py, $kind]}}}"
  done
} >"$out/scenario.yaml"
timeout 200 "$tcsim" run "$out/scenario.yaml" --out "$out/out" >"$out/said" 2>"$out/stderr" || fail "$(cat "$out/stderr")"
for kind in "${kinds[@]}"; do
  grep -q done "$out/out/$kind-c.out.log" || fail "$kind: $(cat "$out/out/$kind-c".*.log)"
done
PYTHONPATH=$source_root/tests/scenario python3 -B - "$out/out" <<'PY' || fail "$(cat "$out/said")"
import csv, json, sys
import planners_charges
COUNT = 30
clients = json.load(open(sys.argv[1] + "/summary.json"))["clients"]
rows = {}
for row in csv.DictReader(open(sys.argv[1] + "/activations.csv")):
    if row["thread"] == "0": rows.setdefault(row["client"], []).append(row)

def of(kind, *causes):
    return [r for r in rows[kind + "/c"] if r["cause"] in causes]

def about(what, number, wanted, slack=1):
    assert wanted - slack <= number <= wanted + slack, (what, number, wanted)

for kind in ("blocking", "polling", "selecting", "raw"):
    got = of(kind, "input")
    about(kind, len(got), COUNT)
    about(kind + " in the summary", clients[kind + "/c"]["activations"], COUNT, 3)
    planners_charges.judge(kind, got[1:-1])
    for row in got[1:-1]:
        assert int(row["release_ns"]) <= int(row["start_ns"]) < int(row["end_ns"]), (kind, row)
    # Each was released when its message came, every 10 ms; a raw call tells only that it has received. A busy host may have
    # some sent late, and has an activation last half of what its thread computes, or far longer (planners_charges).
    between = sorted(int(row["release_ns"]) - int(before["release_ns"]) for before, row in zip(got[1:], got[2:-1]))
    mean = sum(between) / len(between)
    if kind == "raw":
        assert 14e6 < mean < 40e6 and 7e6 < between[0] and between[-1] < 90e6, (kind, between)
    else:
        assert 9.9e6 < mean < 13e6, (kind, between)
        assert all(9.9e6 < ns < 12e6 for ns in between[len(between) // 8:-(len(between) // 8)]), (kind, between)
    ends = [int(r["end_ns"]) for r in got]
    assert ends == sorted(ends), kind
about("waiting", len(of("waiting", "input")), COUNT)
# It may be there before all three of a period are, and on a busy host find those of two periods.
assert COUNT * 4 // 5 <= len(of("draining", "input")) <= 2 * COUNT, of("draining", "input")
# One for each period, which it sleeps to; where it was alone it did so without saying. It waits where its messages are late.
assert len(of("periodic", "input")) <= COUNT // 4, of("periodic", "input")
about("server", len(of("server", "input", "time")), COUNT, 2)
about("timer", len(of("timer", "time")), COUNT, 2)
PY
