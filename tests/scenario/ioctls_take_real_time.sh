#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# An ioctl of a device waits for what is outside of the run, and takes the virtual time that its real time stands for;
# beside it a thread ticks a thousand times a second, and loses no tick. Under set costs it takes what was set.
#
# The device is a terminal. To send it a stop character waits for those who write to it: a process outside does, when it is
# asked for it, and for 33 ms more once it is told that the ioctl begins, because nobody takes what it writes.
# Topics: outside, threads, determinism, timers.
out=$(mktemp -d)
holder=
trap 'kill "$holder" 2>/dev/null || true; rm -rf "$out"' EXIT
cd "$out"
cat >holder.py <<'PY'
import os, select, socket, threading, time, tty
ours, theirs = os.openpty()
tty.setraw(theirs)
os.set_blocking(ours, False)
is_written = threading.Event()
def write():
    left = bytes(256 * 1024)
    while left: left = left[os.write(theirs, left):]
    is_written.set()
def is_full():
    time.sleep(0.002)
    return not select.select([], [theirs], [], 0)[1]
def receive(client):
    try: return client.recv(1)
    except ConnectionResetError: return b""  # it was ended before it had taken all
held = open("held", "a", buffering=1)
listener = socket.socket(socket.AF_UNIX)
listener.bind("holder.sock")
listener.listen()
with open("terminal.new", "w") as f: f.write(os.ttyname(theirs))
os.rename("terminal.new", "terminal")
while True:
    client = listener.accept()[0]
    while receive(client) == b"?":
        is_written.clear()
        threading.Thread(target=write).start()
        while not is_full(): pass
        client.send(b"x")
        receive(client)
        begun = time.monotonic()
        time.sleep(0.033)
        while not is_written.is_set():
            try: os.read(ours, 65536)
            except BlockingIOError: time.sleep(0)
        held.write(f"{(time.monotonic() - begun) * 1e3:.3f}\n")
PY
cat >client.py <<'PY'
# client.py TERMINAL: prints for each of five ioctls how long it took, in ms, and how often a thread ticked meanwhile.
import fcntl, os, socket, sys, termios, threading, time
fd = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
holder = socket.socket(socket.AF_UNIX)
holder.connect("holder.sock")
ticks, is_over = 0, False
def tick():
    global ticks
    due = time.monotonic()
    while not is_over:
        due += 0.001
        time.sleep(max(0, due - time.monotonic()))
        ticks += 1
ticker = threading.Thread(target=tick)
ticker.start()
for _ in range(5):
    holder.send(b"?")
    holder.recv(1)
    holder.send(b"!")
    begun, before = time.monotonic(), ticks
    fcntl.ioctl(fd, termios.TCXONC, termios.TCIOFF)
    took = (time.monotonic() - begun) * 1e3
    print(f"{took:.3f} {ticks - before}")
is_over = True
ticker.join()
PY
# Runs have the processors, and the holder is to be as quick as a device.
on_time python3 holder.py &
holder=$!
for _ in $(seq 1000); do [[ -e terminal ]] && break; sleep 0.05; done
terminal=$(cat terminal)

is_right() {  # WHO, a file with its waits; the shortest is so many times a hold, at least and at most
  python3 - "$@" <<'PY' || fail "$1: $(cat "$2")"
import sys
waits = [line.split() for line in open(sys.argv[2])]
held = min(float(line) for line in open("held"))
least = min(float(took) for took, _ in waits)
assert len(waits) >= 3 and float(sys.argv[3]) * held - 1 <= least <= float(sys.argv[4]) * held + 1, f"{least} ms at least; held for {held} ms"
for took, ticks in waits:
    assert 0.9 * float(took) - 2 <= int(ticks) <= float(took) + 2, f"{ticks} ticks in {took} ms"
PY
}
timeout 100 "$tcsim" exec --outside "$terminal" -- python3 client.py "$terminal" >waits 2>said || fail "$(cat said)"
is_right "exec" waits 0.95 1.05
[[ -z $(without_waits <said) ]] || fail "says: $(cat said)"

# Beside three who compute, so that the run is slower than real time.
burner='{clients: {burner: {command: [python3, -c, "while True: sum(range(1000))"], stop_signal: SIGKILL}}}'
cat >s.yaml <<YAML
duration: 1500ms
robots:
  r:
    clients:
      client: {command: [python3, client.py, "$terminal"], outside: ["$terminal"]}
  a: $burner
  b: $burner
  c: $burner
YAML
timeout 100 "$tcsim" run s.yaml --out slow >said 2>&1 || fail "slow: $(cat said)"
# More real time passes before it begins, and until its thread has a processor to end it.
is_right "slow" slow/r-client.out.log 0.5 3
grep -Eq '^r/client waited [0-9.]+ s for [0-9]+ answers from outside of the run' said || fail "$(cat said)"

for run in 1 2; do
  timeout 100 "$tcsim" exec --accounting fixed --outside "$terminal" --outside-takes 20ms -- python3 client.py "$terminal" \
    >"fixed-$run" 2>said || fail "fixed: $(cat said)"
  awk '$1 < 20 || $1 >= 20.1 || $2 < 19 || $2 > 21 { exit 1 }' "fixed-$run" || fail "fixed: $(cat "fixed-$run")"
done
[[ -z $(new_in_shm) ]] || fail "left in /dev/shm: $(new_in_shm)"
