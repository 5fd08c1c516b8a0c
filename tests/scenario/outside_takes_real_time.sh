#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What answers from outside of the run takes the virtual time that its real time stands for, however the client waits:
# by selects, epoll, looks that do not wait, blocking reads; on UNIX sockets, TCP and UDP; where the run is faster than
# real time, and where it is slower. Beside it a thread ticks a thousand times a second, and loses no tick. Under set
# costs an answer takes exactly what was set. Files that are named count, too; who sends and never looks waits for
# nobody; and nobody is waited for who does not answer for too long.
# Topics: outside, tcp, udp, unix sockets, determinism, timers.
out=$(mktemp -d)
trap 'kill "${outside[@]}" 2>/dev/null || true; rm -rf "$out"' EXIT
outside=()
cd "$out"
cat >server.py <<'PY'
# server.py SECONDS PORT: answers each byte at the UNIX socket server.sock, and at the port by TCP and by UDP, after so
# long, and writes into the file "served" how long each took by its own clock, in ms.
import os, socket, sys, threading, time
wait, port = float(sys.argv[1]), int(sys.argv[2])
served = open("served", "a", buffering=1)
def answer(begun, send):
    time.sleep(wait)
    send(b"x")
    served.write(f"{(time.monotonic() - begun) * 1e3:.3f}\n")
def serve(connection):
    try:
        while connection.recv(1): answer(time.monotonic(), connection.send)
    except OSError: pass  # the client has given up
def listen(listener):
    listener.listen()
    while True: threading.Thread(target=serve, args=[listener.accept()[0]], daemon=True).start()
unix, tcp, udp = socket.socket(socket.AF_UNIX), socket.socket(), socket.socket(type=socket.SOCK_DGRAM)
if os.path.exists("server.sock"): os.unlink("server.sock")
unix.bind("server.sock")
tcp.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
for each in tcp, udp: each.bind(("127.0.0.1", port))
for each in unix, tcp: threading.Thread(target=listen, args=[each], daemon=True).start()
open("ready", "w").close()
while True:
    _, sender = udp.recvfrom(10)
    answer(time.monotonic(), lambda data: udp.sendto(data, sender))
PY
cat >client.py <<'PY'
# client.py PEER WAY SECONDS ANSWERS: prints for each answer how long it took, in ms, and how often it was looked for in vain.
import asyncio, select, socket, sys, time
peer, way, wait, answers = sys.argv[1], sys.argv[2], float(sys.argv[3]), int(sys.argv[4])
def connected():
    if peer == "unix":
        s = socket.socket(socket.AF_UNIX)
        s.connect("server.sock")
        return s
    s = socket.socket(type=socket.SOCK_STREAM if peer == "tcp" else socket.SOCK_DGRAM)
    s.connect(("127.0.0.1", int(sys.argv[5])))
    return s
s = connected()
def by_select():
    looks = 0
    while not select.select([s], [], [], wait)[0]: looks += 1
    return looks
def by_poll():
    poll, looks = select.poll(), 0
    poll.register(s, select.POLLIN)
    while not poll.poll(wait * 1e3): looks += 1
    return looks
def by_epoll():
    epoll, looks = select.epoll(), 0
    epoll.register(s, select.EPOLLIN | select.EPOLLET)
    while not epoll.poll(wait): looks += 1
    return looks
def by_looks():
    looks = 0
    while True:
        time.sleep(wait)
        try:
            s.recv(1, socket.MSG_DONTWAIT | socket.MSG_PEEK)
            return looks
        except BlockingIOError: looks += 1
def by_timeouts():
    looks = 0
    s.settimeout(wait)
    while True:
        try:
            s.recv(1, socket.MSG_PEEK)
            return looks
        except TimeoutError: looks += 1
def by_waiting():
    s.recv(1, socket.MSG_PEEK)
    return 0
async def loop():
    reader, writer = await asyncio.open_connection(sock=s)
    ticks = 0
    async def tick():
        nonlocal ticks
        while True:
            await asyncio.sleep(wait)
            ticks += 1
    ticking = asyncio.create_task(tick())
    for _ in range(answers):
        asked, before = time.monotonic(), ticks
        writer.write(b"q")
        await reader.read(1)
        print(f"{(time.monotonic() - asked) * 1e3:.3f} {ticks - before}")
if way == "loop":
    asyncio.run(loop())
    sys.exit()
for _ in range(answers):
    asked = time.monotonic()
    s.send(b"q")
    looks = globals()["by_" + way]()
    s.recv(1)
    print(f"{(time.monotonic() - asked) * 1e3:.3f} {looks}")
PY
cat >ticker.py <<'PY'
import os, time
begun = due = time.monotonic()
for _ in range(500):
    due += 0.001
    time.sleep(max(0, due - time.monotonic()))
print(f"{time.monotonic() - begun:.3f}", flush=True)
os._exit(0)  # to end Python computes for 20 ms, in which the client does not look
PY
# Runs have the processors, and the server is to be as quick as one on another computer.
serve() {  # SECONDS
  rm -f ready
  on_time python3 server.py "$1" 27519 & outside+=("$!")
  for _ in $(seq 2000); do [[ -e ready ]] && return; sleep 0.05; done
  fail "the server does not begin"
}
# The least of the answers, for what answers is not of the run, and a busy host may keep it waiting. But for one: a program
# whose processor the host has taken unseen has a clock that is ahead until it has computed as much, which an answer that it
# waits for then seems shorter by.
is_right() {  # WHO, a file with its answers, seconds of its looks
  python3 - "$@" <<'PY' || fail "$1: $(cat "$2")"
import sys
answers = [line.split() for line in open(sys.argv[2])]
served = min(float(line) for line in open("served"))
least = sorted(float(took) for took, _ in answers)[1]
assert served - 0.5 <= least <= 1.05 * served + 1, f"an answer took {least} ms at least, and the server {served} ms"
period = float(sys.argv[3]) * 1e3
for took, looks in answers:
    assert period == 0 or 0.5 * float(took) / period - 3 <= int(looks) <= float(took) / period, f"{looks} looks in {took} ms"
PY
}
answers_by() {  # PEER WAY SECONDS
  timeout 200 "$tcsim" exec -- python3 client.py "$1" "$2" "$3" 5 27519 >"answers-$1-$2" 2>"said" || fail "$*: $(cat said)"
  is_right "$*" "answers-$1-$2" "$3"
}
serve 0.033
answers_by unix select 0.001
answers_by tcp select 0.1
answers_by tcp poll 0.01
answers_by unix epoll 0.001
answers_by udp looks 0.001
answers_by udp epoll 0.01
answers_by tcp timeouts 0.01
answers_by unix waiting 0
answers_by tcp loop 0.001
# Go makes its calls past the shim. Nobody's deadlines run out meanwhile.
if command -v go >/dev/null; then
  cat >client.go <<'GO'
package main

import (
	"fmt"
	"net"
	"os"
	"time"
)

func main() {
	connection, err := net.DialTimeout("tcp", os.Args[1], 5*time.Second)
	answer := make([]byte, 1)
	for i := 0; err == nil && i < 5; i++ {
		asked := time.Now()
		connection.SetDeadline(asked.Add(3 * time.Second))
		if _, err = connection.Write([]byte("q")); err == nil {
			_, err = connection.Read(answer)
		}
		fmt.Printf("%.3f 0\n", time.Since(asked).Seconds()*1e3)
	}
	if err != nil {
		fmt.Println(err)
		os.Exit(1)
	}
}
GO
  HOME=$out GOCACHE=$out/go GOFLAGS=-mod=mod go build -o client client.go
  timeout 200 "$tcsim" exec -- ./client 127.0.0.1:27519 >answers-go 2>said || fail "go: $(cat answers-go said)"
  is_right go answers-go 0
  timeout 200 "$tcsim" exec --accounting fixed --outside-takes 20ms -- ./client 127.0.0.1:27519 >answers-go 2>said ||
    fail "go, set costs: $(cat answers-go said)"
  awk '$1 < 20 || $1 >= 20.1 { exit 1 }' answers-go || fail "go, set costs: $(cat answers-go)"
fi

# Beside others: a thread that ticks, more urgent; and computers that compute, so that the run is slower than real time.
cat >s.yaml <<'YAML'
duration: 1500ms  # twice what it takes: an answer may be late on a busy host
robots:
  r:
    clients:
      client: {command: [python3, client.py, tcp, epoll, "0.001", "10", "27519"]}
      ticker: {command: [python3, ticker.py], priority: 1}
YAML
burner='{clients: {burner: {command: [python3, -c, "while True: sum(range(1000))"], stop_signal: SIGKILL}}}'
for name in fast slow; do
  timeout 200 "$tcsim" run s.yaml --out "$name" >said 2>&1 || fail "$name: $(cat said)"
  is_right "$name" "$name/r-client.out.log" 0.001
  [[ $(cat "$name/r-ticker.out.log") == 0.500 ]] || fail "$name: ticks took $(cat "$name/r-ticker.out.log") s"
  grep -Eq '^r/client waited [0-9.]+ s for [0-9]+ answers from outside of the run, [0-9.]+ ms each$' said || fail "$(cat said)"
  for robot in a b c; do printf '  %s: %s\n' "$robot" "$burner" >>s.yaml; done
done

# Under set costs: what was set, whether the server is quicker or slower than that.
for takes in 5ms 100ms; do
  ms=${takes%ms}
  for client in 'unix select 0.001' 'udp looks 0.001' 'tcp loop 0.001' 'tcp epoll 0.01'; do
    for run in 1 2; do
      [[ $takes == 100ms && $run == 2 ]] && continue
      # shellcheck disable=SC2086  # words of a command
      timeout 200 "$tcsim" exec --accounting fixed --outside-takes "$takes" -- python3 client.py $client 3 27519 >"fixed-$run" 2>said ||
        fail "$client, $takes: $(cat said)"
    done
    [[ $takes == 100ms ]] || cmp fixed-1 fixed-2 || fail "$client, $takes: two runs differ: $(cat fixed-1 fixed-2)"
    awk -v ms="$ms" '$1 < ms || $1 >= ms + ($2 > 20 ? 1 : 0.1) || !NF { exit 1 }' fixed-1 || fail "$client, $takes: $(cat fixed-1)"
  done
done

# Files that are named: bytes that come each 40 ms of real time by a FIFO and a terminal.
cat >writer.py <<'PY'
import os, sys, time
os.mkfifo("fifo")
ours, theirs = os.openpty()
with open("terminal.new", "w") as f: f.write(os.ttyname(theirs))
fifo = os.open("fifo", os.O_RDWR)
for fd in fifo, ours: os.set_blocking(fd, False)
os.rename("terminal.new", "terminal")
while True:
    time.sleep(0.04)
    for fd, text in (fifo, b"x"), (ours, b"x\n"):
        try: os.write(fd, text)
        except BlockingIOError: pass  # nobody has read it for long
PY
cat >reader.py <<'PY'
import os, select, sys, termios, time
fd = os.open(sys.argv[1], os.O_RDONLY | os.O_NOCTTY | os.O_NONBLOCK)
if os.isatty(fd): termios.tcflush(fd, termios.TCIFLUSH)  # lines from before come one by one
times, looks = [], 0
while len(times) < 12:
    while not select.select([fd], [], [], 0.001)[0]: looks += 1
    os.read(fd, 100)
    times.append(time.monotonic())
apart = sorted(b - a for a, b in zip(times, times[1:]))
print(f"{apart[len(apart) // 2] * 1e3:.1f}")
PY
on_time python3 writer.py & outside+=("$!")
for _ in $(seq 2000); do [[ -e terminal ]] && break; sleep 0.05; done
for file in fifo "$(cat terminal)"; do
  apart=$(timeout 200 "$tcsim" exec --outside "$file" -- python3 reader.py "$file" 2>said) || fail "$file: $(cat said)"
  # The writer sleeps 40 ms, and takes its time.
  awk -v ms="$apart" 'BEGIN { exit !(ms >= 39 && ms < 60) }' || fail "$file: bytes came each $apart ms"
done

# Nobody waits for those whom nobody looks at, and for those who do not answer only as long as was set.
[[ $(timeout 200 "$tcsim" exec -- python3 -c '
import socket, time
s = socket.socket(socket.AF_UNIX)
s.connect("server.sock")
s.send(b"a line of a log")
time.sleep(3600)
print("done")' 2>said) == done ]] || fail "a sender: $(cat said)"
kill "${outside[0]}"
wait "${outside[0]}" 2>/dev/null || true
serve 3
cat >patience.yaml <<'YAML'
duration: 100s
robots:
  r: {clients: {client: {command: [python3, client.py, unix, select, "1", "1"], outside: {patience: 200ms}}}}
YAML
timeout 200 "$tcsim" run patience.yaml --out patience >said 2>&1 || fail "patience: $(cat said)"
grep -q "r/client has waited 0.2 s, of real time, for server.sock, which is outside of the run" said || fail "not named: $(cat said)"
[[ -z $(new_in_shm) ]] || fail "left in /dev/shm: $(new_in_shm)"
