"""The checks of live_runs_are_held.sh."""
import csv
import filecmp
import json
import os
import signal
import socket
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

from live import LiveRun

TCSIM, SCENARIO, OUT = sys.argv[1:]
MS = 1_000_000
FILES = ["bodies.csv", "joints.csv", "commands.csv", "output.csv", "scene.json", "trace.json", "activations.csv", "dispatches.csv"]


def start(name, *options, **more):
    return LiveRun(TCSIM, SCENARIO, f"{OUT}/{name}", "--duration", "2s", *options, **more)


def is_the_same(name):
    for file in FILES:
        assert filecmp.cmp(f"{OUT}/plain/{file}", f"{OUT}/{name}/{file}", shallow=False), f"{file} differs"


def last_moment(run):
    with open(f"{run.out}/bodies.csv") as lines:
        return max((float(row["time_s"]) for row in csv.DictReader(lines)), default=-1)


def latest_turn(run):
    with open(f"{run.out}/dispatches.csv") as lines:
        return max((int(row["virtual_start_ns"]) for row in csv.DictReader(lines)), default=0)


def server_of(run):
    """The children of tcsim are its keeper and the server."""
    children = subprocess.run(["pgrep", "-P", str(run.process.pid), "-x", "tcsim-view"], capture_output=True, text=True)
    return int(children.stdout)


def steps():
    with start("steps", "--pause") as run:
        assert "where it is paused until the page lets it go on" in run.words()
        run.stands_at(0)
        # Where everything is at the start is a moment, which the server may have seen by now.
        to = run.news()["to"]
        assert to["moments"] <= 1 and to["slices"] == 0, ("something happened before the start", to)
        at = 0
        for step in (100 * MS, 37 * MS, 1, 12_345_678, 3 * MS):
            run.control(f"step {step}")
            at += step
            run.stands_at(at)
            assert latest_turn(run) <= at
        # What happens at that very moment has happened: a line each 10 ms.
        run.control(f"step {10 * MS - at % (10 * MS)}")
        at += 10 * MS - at % (10 * MS)
        run.stands_at(at)
        run.until(lambda: last_moment(run) == at / 1e9)
        # A step in the middle of another one adds to it.
        run.ask("control", b"pace 0.25")
        for _ in range(3):
            assert run.ask("control", f"step {20 * MS}".encode())[0] == 200
        at += 60 * MS
        run.stands_at(at)
        run.control("pace 0")
        time.sleep(6)  # longer than a standstill is borne in silence
        assert run.status()["now"] == at
        run.tell("go")
        words = run.end()
        assert "it was paused for" in words and "stood still" not in words, words
    is_the_same("steps")
    with open(f"{OUT}/steps/summary.json") as file:
        assert json.load(file)["pace"]["stood_ns"] > 5_000 * MS


def pauses():
    """Again and again while it goes, at another pace each time: so slow that it hears of it before its end on any host."""
    with start("pauses", "--pace", "0.05") as run:
        before = -1
        for pace in ("0.05", "0.02", "0.1"):
            assert run.control(f"pace {pace}")["pace"] == float(pace)
            run.until(lambda: run.status()["now"] > before)
            run.control("stand")
            stands = run.until(lambda: (now := run.status())["stage"] == "stands" and now)["now"]
            assert stands > before
            before = stands
            time.sleep(0.1)
            assert run.status()["now"] == stands
            run.control("go")
        run.control("stand")
        at = run.until(lambda: (now := run.status())["stage"] == "stands" and now)["now"]
        for pace in ("5", "1000", "0"):
            run.control(f"pace {pace}")
            run.control(f"step {50 * MS}")
            at += 50 * MS
            run.stands_at(at)
        # As fast as it can, it may hear the second of these on its way, or not at all.
        for words in ("go", "stand", "go"):
            run.tell(words)
        run.end()
    is_the_same("pauses")


def bad_watchers():
    """One asks for the page and never reads it, one says half a request, and the server is stopped."""
    with start("bad", "--pause", held=True) as run:
        held = []
        for request in (f"GET /{run.token}/ HTTP/1.1\r\nHost: 127.0.0.1:{run.port}\r\n\r\n", "GET /", ""):
            held.append(socket.create_connection(("127.0.0.1", run.port)))
            held[-1].setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            held[-1].sendall(request.encode())
        run.tell("go")
        os.kill(server_of(run), signal.SIGSTOP)
        run.release()
        run.end()
        for one in held:
            one.close()
    is_the_same("bad")


def a_dead_server():
    with start("dead", "--pause") as run:
        run.stands_at(0)
        os.kill(server_of(run), signal.SIGKILL)
        words = run.end()
        assert "the server of the page has ended" in words and "it goes on" in words, words
    is_the_same("dead")


def an_end_while_it_stands():
    for number in (signal.SIGINT, signal.SIGTERM):
        with start("ended", "--pause") as run:
            run.control(f"step {200 * MS}")
            run.stands_at(200 * MS)
            run.process.send_signal(number)
            run.end(128 + number)
        with open(f"{OUT}/ended/summary.json") as file:
            summary = json.load(file)
        assert summary["interrupted"] and 200 * MS <= summary["virtual_ns"] <= 202 * MS, summary["virtual_ns"]


COMPUTES = """
import time
for _ in range(12):
    begun = time.monotonic()
    sum(range(4_000_000))
    print(time.monotonic() - begun, flush=True)
    time.sleep(0.05)
"""


def computing_is_charged():
    """A program that is held in the middle of what it computes has computed it at the same virtual times."""
    with open(f"{OUT}/computes.yaml", "w") as file:
        file.write("duration: 20s\ndynamics: {}\nbodies: {b: {mass: 1, inertia: [1, 1, 1]}}\n"
                   f"robots: {{b: {{clients: {{c: {{command: [python3, -c, {json.dumps(COMPUTES)}]}}}}}}}}\n")
    with LiveRun(TCSIM, f"{OUT}/computes.yaml", f"{OUT}/computes", "--pause", accounting="measured") as run:
        for _ in range(12):  # no more than the program sleeps alone: it has not ended then
            assert run.control(f"step {50 * MS}")["stage"] != "ended"
            time.sleep(0.1)
        run.tell("go")
        run.end()
    with open(f"{OUT}/computes/summary.json") as file:
        client = json.load(file)["clients"]["b/c"]
    with open(f"{OUT}/computes/b-c.out.log") as file:
        took = [float(line) for line in file]
    assert len(took) == 12 and client["wait_status"] == 0, (took, client)
    # What the kernel says that it has used is what its clock says that it took.
    assert abs((client["charged_ns"] - client["priced_ns"]) / client["host_cpu_ns"] - 1) < 0.02, client
    assert 0.6 < sum(took) / (client["charged_ns"] / 1e9) < 1.01, (took, client)


def sentences():
    """What is asked for in vain is said in one line each."""
    def fails(*words):
        done = subprocess.run([TCSIM, *words], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        lines = done.stderr.splitlines()
        assert done.returncode == 2 and len(lines) == 1, (words, done)
        return lines[0]
    assert "--pause needs --view" in fails("run", SCENARIO, "--pause", "--out", f"{OUT}/none")
    assert "is not a place to listen at" in fails("run", SCENARIO, "--view=here", "--out", f"{OUT}/none")
    assert "choose another one" in fails("run", SCENARIO, "--view=192.0.2.1:80", "--out", f"{OUT}/none")
    assert "--pace" in fails("run", SCENARIO, "--pace", "0", "--out", f"{OUT}/none")
    with open(f"{OUT}/flat.yaml", "w") as file:
        file.write("duration: 1s\nrobots: {r: {clients: {c: {command: ['true']}}}}\n")
    assert "has none" in fails("run", f"{OUT}/flat.yaml", "--pace", "1", "--out", f"{OUT}/none")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        words = fails("run", SCENARIO, f"--view={taken.getsockname()[1]}", "--out", f"{OUT}/none")
        assert "choose another one" in words, words
    os.makedirs(f"{OUT}/empty")
    assert "is no result of `tcsim run`" in fails("view", f"{OUT}/empty")


# Two at a time: that of `steps` stands for long.
with ThreadPoolExecutor(2) as two:
    checks = [(check, two.submit(check)) for check in
              (steps, pauses, bad_watchers, a_dead_server, an_end_while_it_stands, computing_is_charged, sentences)]
    for its_check, outcome in checks:
        outcome.result()
        print(its_check.__name__, flush=True)
