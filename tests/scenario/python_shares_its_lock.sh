#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Under set costs every round of a loop takes the same time. Python's threads get its lock from one another all the same, on one
# core and on four, whatever a call costs: pools of 2 to 8 processes, a loop of sleep(0) beside a thread that sets a flag, a loop
# of reads that find nothing beside a thread that reads. Each takes the time that it takes natively, and two runs are the same.
# Topics: languages, threads, processes, determinism.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/pool.py" <<'PY'
import multiprocessing, socket, sys, threading, time

def square(x):
    time.sleep(0.01)
    return x * x

def pools(workers):
    with multiprocessing.Pool(workers) as pool:
        assert pool.map(square, range(24), chunksize=1) == [x * x for x in range(24)]
        assert list(pool.imap(square, range(24))) == [x * x for x in range(24)]
        assert [pool.apply(square, (x,)) for x in range(5)] == [x * x for x in range(5)]

def flag():
    done = []
    thread = threading.Thread(target=lambda: (time.sleep(0.1), done.append(1)))
    thread.start()
    while not done: time.sleep(0)
    thread.join()

def reads():
    one, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    idle, _ = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    idle.setblocking(False)
    got = []
    thread = threading.Thread(target=lambda: got.append(one.recv(10)))
    thread.start()
    threading.Timer(0.1, lambda: other.send(b"x")).start()
    while not got:
        try: idle.recv(10)
        except BlockingIOError: pass
    thread.join()

def took(what, least, most, work):
    begun = time.monotonic()
    work()
    passed = time.monotonic() - begun
    print(f"{what} took {passed:.9f} s")
    if not least <= passed < most: print(f"that is not {least} s")

workers = int(sys.argv[1])
sleeps = 0.01 * (5 + 2 * (24 // workers))
took("the pools", sleeps, sleeps + 0.05, lambda: pools(workers))
took("the flag", 0.1, 0.15, flag)
took("reading", 0.1, 0.2, reads)
PY
takes() {  # WORKERS CORES COST
  said=$(timeout 60 "$tcsim" exec --accounting fixed --cores "$2" --call-cost "$3" -- python3 "$out/pool.py" "$1" 2>&1) ||
    fail "$*: status $?: $said"
  said=$(without_waits <<<"$said")
  [[ $(wc -l <<<"$said") == 3 && $said != *"that is not"* ]] || fail "$*: $said"
}
for workers in 2 3 4 8; do
  for cores in 1 4; do takes "$workers" "$cores" 1us; done
done
for cost in 100ns 331ns 3127ns 10us; do takes 4 1 "$cost"; done
takes 4 4 1us
first=$said
takes 4 4 1us
[[ $said == "$first" ]] || fail "two runs differ: $first and $said"
