"""whoever_is_killed.py TCSIM BIN ROUNDS: kill -9 of every party of a run, ROUNDS times at random instants.

Nothing hangs, and nothing is left: no process (and so no real-time thread, and no claim of a CPU),
and nothing in /dev/shm. What ends the run is said in one sentence, and the results can be read.
"""

import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

TCSIM, BIN, ROUNDS = sys.argv[1], sys.argv[2], int(sys.argv[3])
MARK = "TCS_TEST_MARK=%d.%d" % (os.getpid(), time.time_ns())
KILLED = "what it has written until then can be read"
# What a run says that ends for it; None: it goes on.
SENTENCES = {
    "guardian": r"tcsim \(process \d+\) was killed; its run ends",
    "keeper": r"the process that watches over the run \(process \d+\) was killed, .*" + KILLED,
    "coordinator": r"the coordinator was killed by signal 9 .*" + KILLED,
    "detector": r"the block detector \(process \d+\) was killed by signal 9, .*" + KILLED,
    "group": "",
    "client": None,
    "child": None,
}
# A spinning child in a session of its own, forked twice, one that ignores signals, and threads.
SCENARIO = """
duration: 5min
dynamics: {}
bodies: {ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
robots:
  one:
    cpu: {cores: 2}
    clients:
      spinner: {command: [sh, -c, "(setsid sh -c 'while :; do :; done' &) ; trap '' TERM HUP; while :; do sleep 0.01; done"]}
      threads: {command: [%(bin)s/soak_client, threads, "3600"]}
  two: {clients: {children: {command: [%(bin)s/soak_client, children, "3600"]}}}
""" % {"bin": BIN}


def marked():
    """All processes of the run, by what they inherit."""
    found = []
    for entry in os.listdir("/proc"):
        if entry.isdigit() and int(entry) != os.getpid():
            try:
                environment = pathlib.Path("/proc", entry, "environ").read_bytes()
                if MARK.encode() in environment:
                    found.append(int(entry))
            except OSError:
                pass
    return found


def children(pid):
    try:
        return [int(c) for c in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        return []


def name(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/comm").read_text().strip()
    except OSError:
        return ""


def find(party, guardian):
    """The process that plays this part by now, or None."""
    if party in ("guardian", "group"):
        return guardian
    keeper = next(iter(children(guardian)), None)
    if party == "keeper" or keeper is None:
        return keeper
    coordinator = next(iter(children(keeper)), None)
    if party == "coordinator" or coordinator is None:
        return coordinator
    of_coordinator = children(coordinator)
    if party == "detector":
        return next((c for c in of_coordinator if name(c) == "tcsim"), None)
    clients = [c for c in of_coordinator if name(c) != "tcsim"]
    if party == "client":
        return random.choice(clients) if clients else None
    grandchildren = [g for c in clients for g in children(c)]
    return random.choice(grandchildren) if grandchildren else None


def until(condition, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.05)
    return condition()


def one_round(party, folder):
    environment = dict(os.environ, **dict([MARK.split("=")]))
    said = folder / "said"
    with open(said, "w") as err:
        run = subprocess.Popen([TCSIM, "run", str(folder / "scenario.yaml"), "--out", str(folder / "out")],
                               stdout=subprocess.DEVNULL, stderr=err, env=environment, process_group=0)
    try:
        table = folder / "out/dispatches.csv"

        def has_begun():
            return table.exists() and table.read_text().count("\n") > 1

        if random.random() < 0.8:  # else while it starts
            if not until(has_begun, 200):
                return "the run did not begin"
        time.sleep(random.random() * 0.4)
        victim = find(party, run.pid)
        if victim is None:
            party, victim = "guardian", run.pid
        was_running = has_begun()
        try:
            os.kill(-victim if party == "group" else victim, signal.SIGKILL)
        except ProcessLookupError:  # it has ended by itself just now
            party, victim = "guardian", run.pid
            os.kill(victim, signal.SIGKILL)
        ends = SENTENCES[party] is not None
        if not ends:
            time.sleep(0.3)
            if run.poll() is not None:
                return f"the run ended with its {party}"
            run.terminate()
        try:
            run.wait(100)
        except subprocess.TimeoutExpired:
            return "tcsim hangs"
        if not until(lambda: not marked(), 60):
            return "there is still: " + ", ".join("%d %s" % (pid, name(pid)) for pid in marked())
        words = said.read_text()
        words = re.sub(r"tcsim: other runs of tcsim have.*\n", "", words)
        # The spinner ignores SIGTERM, on purpose, and that is said, too.
        words = re.sub(r"tcsim: warning: \S+ was killed: after SIGTERM it did not end within.*\n", "", words)
        if ends and was_running and SENTENCES[party]:
            if not re.search("^tcsim: " + SENTENCES[party], words, re.M):
                return "it says: " + words
            if len(words.splitlines()) != 1:
                return "more than one line: " + words
        if was_running and ends and party not in ("guardian",):
            return unread(folder / "out")
        return ""
    finally:
        for pid in marked():
            os.kill(pid, signal.SIGKILL)
        run.wait()


def unread(out):
    """What is wrong with the results of a run that was cut off."""
    json.loads((out / "trace.json").read_text())
    for table in out.glob("*.csv"):
        text = table.read_text()
        columns = text.split("\n", 1)[0].count(",")
        if not text.endswith("\n") or any(line.count(",") != columns for line in text.splitlines()):
            return f"{table.name} ends in half a line"
    report = subprocess.run([TCSIM, "report", str(out), "--out", str(out / "page.html")], timeout=200,
                            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if report.returncode != 0 or "cut off" not in report.stderr:
        return f"report: status {report.returncode}: {report.stderr}"
    return ""


def main():
    random.seed(int(os.environ.get("TCS_SEED", "1")))
    shared = set(os.listdir("/dev/shm"))
    bad = 0
    for number in range(ROUNDS):
        for party in SENTENCES:
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                (folder / "scenario.yaml").write_text(SCENARIO)
                wrong = one_round(party, folder)
                if wrong:
                    bad += 1
                    print(f"round {number}, {party}: {wrong}", flush=True)
    left = [entry for entry in set(os.listdir("/dev/shm")) - shared if "tcs" in entry]
    if left:
        sys.exit(f"left in /dev/shm: {left}")
    print(f"{ROUNDS} rounds of {len(SENTENCES)} parties, {bad} went wrong")
    sys.exit(bad != 0)


main()
