#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Every way that Python sleeps and waits is virtual: the sum of them all is exact to 0.1 s.
# Topics: languages, timers.
program='
import time, select, socket, signal
t0, m0 = time.time(), time.monotonic()
time.sleep(1000)
select.select([], [], [], 2000)
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 0))
s.settimeout(600)
try:
    s.recv(10)
except TimeoutError:
    pass
hits = []
signal.signal(signal.SIGALRM, lambda *a: hits.append(time.monotonic()))
signal.setitimer(signal.ITIMER_REAL, 5, 5)
while len(hits) < 3:
    signal.pause()
print(round(time.time() - t0, 1), round(time.monotonic() - m0, 1))
'
said=$("$tcsim" exec -- python3 -c "$program")
[[ $said == "3615.0 3615.0" ]] || fail "expected 3615.0 3615.0, got: $said"
