#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$(dirname -- "${BASH_SOURCE[0]}")/planners_world.sh"
# A planner whose next message is always there in a queue of the kernel's, System V's or POSIX's, has
# an activation for each message that it takes, though it never waits. One that takes all there is at
# each turn has one for the turn.
# Topics: activations.
out=$(mktemp -d)
keys=$((($$ & 0xffffff) * 16))
remove_queues() {
  for i in 0 1 2 3 4 5; do ipcrm -Q $((keys + i)) 2>/dev/null || true; done
  rm -f "/dev/mqueue/tcs-test-$keys" 2>/dev/null || true
  rm -rf "$out"
}
trap remove_queues EXIT
python=$(python3 -c 'import sys; print(sys.executable)')  # python3 may be a script that runs it
cat >"$out/client.py" <<'PY'
import ctypes, errno, sys, time

COUNT = 30
PERIOD = 0.01
IPC_CREAT, IPC_NOWAIT = 0o1000, 0o4000
KINDS = ["blocking", "polling", "waiting", "draining"]
libc = ctypes.CDLL(None, use_errno=True)
libc.mq_open.argtypes = [ctypes.c_char_p, ctypes.c_int, ctypes.c_int, ctypes.c_void_p]
kind, keys = sys.argv[1], int(sys.argv[2])
name = b"/tcs-test-%d" % keys

class Message(ctypes.Structure):
    _fields_ = [("type", ctypes.c_long), ("text", ctypes.c_char * 8)]

def queue(of):
    number = libc.msgget(keys + KINDS.index(of), IPC_CREAT | 0o600)
    assert number >= 0, ctypes.get_errno()
    return number

def posix_queue():
    attributes = (ctypes.c_long * 8)(0, 10, 8)
    number = libc.mq_open(name, 0o102, 0o600, attributes)
    assert number >= 0, ctypes.get_errno()
    return number

def compute(seconds):
    end = time.thread_time() + seconds
    while time.thread_time() < end: pass

def take(flags):
    got = libc.msgrcv(queue_number, ctypes.byref(message), ctypes.c_size_t(8), ctypes.c_long(0), flags)
    assert got == 8 or ctypes.get_errno() == errno.ENOMSG, ctypes.get_errno()
    return got == 8

message = Message(1, b"message")
if kind == "source":
    queues = {of: queue(of) for of in KINDS}
    posix = posix_queue()
    time.sleep(max(0, 1000.5 - time.monotonic()))  # on the run's clock
    for i in range(COUNT):
        for of, number in queues.items():
            for further in range(3 if of == "draining" else 1):
                assert libc.msgsnd(number, ctypes.byref(message), ctypes.c_size_t(8), 0) == 0
        assert libc.mq_send(posix, b"message", ctypes.c_size_t(8), 0) == 0
        time.sleep(PERIOD)
    assert libc.mq_unlink(name) == 0
elif kind == "posix":
    posix = posix_queue()
    buffer = ctypes.create_string_buffer(8)
    for i in range(COUNT):
        assert libc.mq_receive(posix, buffer, ctypes.c_size_t(8), None) == 8, ctypes.get_errno()
        compute(0.015)
else:
    queue_number = queue(kind)
    took = 0
    while took < (3 * COUNT if kind == "draining" else COUNT):
        if kind == "polling":
            if not take(IPC_NOWAIT): continue
        else:
            assert take(0)
        took += 1
        while kind == "draining" and take(IPC_NOWAIT): took += 1
        compute(0.002 if kind in ("waiting", "draining") else 0.015)
print("done", flush=True)
PY
kinds=(blocking polling waiting draining posix)
fly_planners "[$python, client.py, KIND, '$keys']"
PYTHONPATH=$source_root/tests/scenario python3 -B - "$out/out" <<'PY' || fail "$(cat "$out/said")"
import csv, sys
import planners_charges
COUNT = 30
rows = {}
for row in csv.DictReader(open(sys.argv[1] + "/activations.csv")):
    if row["thread"] == "0" and row["cause"] == "input": rows.setdefault(row["client"], []).append(row)
for kind in ("blocking", "polling", "posix"):
    got = rows[kind + "/c"]
    assert COUNT - 1 <= len(got) <= COUNT + 1, (kind, len(got))
    planners_charges.judge(kind, got[1:-1])
    for row in got[1:-1]:
        assert int(row["release_ns"]) == int(row["start_ns"]) < int(row["end_ns"]), (kind, row)
assert COUNT - 1 <= len(rows["waiting/c"]) <= COUNT + 1, len(rows["waiting/c"])
# It may be there before all three of a period are, and on a busy host find those of two periods.
assert COUNT * 4 // 5 <= len(rows["draining/c"]) <= 2 * COUNT, len(rows["draining/c"])
PY
