#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A client's row counts all that it has started: what a shell runs, children of children, those that
# go into the background by themselves, threads that have ended, and threads killed with their process.
# Topics: accounting, processes, threads.
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

cat >work.py <<'PY'
import ctypes, os, subprocess, sys, threading, time

def compute(seconds):
    end = time.thread_time() + seconds
    while time.thread_time() < end: pass

def say():
    with open("said", "a") as file: file.write(f"{kind} {time.process_time()}\n")

kind = sys.argv[1]
if kind == "child":
    compute(0.3)
    subprocess.run([sys.executable, "work.py", "grandchild"], check=True)
elif kind == "grandchild":
    compute(0.2)
elif kind == "daemon":
    if os.fork() == 0:
        os.setsid()
        if os.fork() != 0: os._exit(0)
        compute(0.2)
        say()
        os._exit(0)
    os.wait()
elif kind == "orphan":  # made past the C library, and its parent is gone before it says who it is
    if ctypes.CDLL(None).syscall(57) != 0: os._exit(0)
    compute(0.2)
elif kind == "ended":
    thread = threading.Thread(target=compute, args=(0.2,))
    thread.start()
    thread.join()
elif kind == "killed":
    threading.Thread(target=lambda: (compute(0.2), time.sleep(100))).start()
    time.sleep(1)
    say()
    os._exit(0)
elif kind == "lives":  # as the run ends
    compute(0.2)
    say()
    while True: time.sleep(100)
say()
PY
cat >scenario.yaml <<'YAML'
duration: 8s
robots:
  idle:
    clients: {idle: {command: [sleep, "1"]}}
  busy:
    clients:
      wrapper:
        command:
          - sh
          - -c
          - for kind in child daemon orphan ended killed; do python3 work.py $kind; done; python3 work.py lives
      alone: {command: [sleep, "1"]}
YAML
timeout 200 "$tcsim" run scenario.yaml --out out >summary 2>stderr || fail "$(cat stderr)"
python3 - <<'PY' || fail "$(cat said summary stderr)"
import json
clients = json.load(open("out/summary.json"))["clients"]
wrapper = clients["busy/wrapper"]
said = [line.split() for line in open("said")]
assert sorted(kind for kind, _ in said) == sorted(
    "child grandchild daemon daemon orphan ended killed lives".split()), said
own = sum(float(seconds) for _, seconds in said)
charged, clock = wrapper["charged_ns"] * 1e-9, wrapper["host_cpu_ns"] * 1e-9
# To end an interpreter takes time, too.
assert 1.5 < own <= charged < own + 0.15 * len(said), (own, charged)
# To 1 %, and what each process may have been charged too much at its end, on a busy host; each computes 0.2 s at least.
assert abs(charged - clock) < 0.03 * clock, (charged, clock)
assert clients["busy/alone"]["charged_ns"] < 50e6, clients["busy/alone"]
assert clients["idle/idle"]["charged_ns"] < 50e6, clients["idle/idle"]
PY
grep -Eq 'busy/wrapper +[1-9]\.[0-9]+ s' summary || fail "$(cat summary)"  # more than 3 s on a slow host
# The report's table has the same.
"$tcsim" report out >page.txt 2>&1 || fail "$(cat page.txt)"
python3 - <<'PY' || fail "the report says otherwise"
import json, re
charged = json.load(open("out/summary.json"))["clients"]["busy/wrapper"]["charged_ns"] * 1e-9
rows = re.findall(r"busy/wrapper</t[dh]>(.*?)</tr>", open("report.html").read(), re.S)
cells = [cell for row in rows for cell in re.findall(r"<td[^>]*>([^<]*)</td>", row)]
assert any(re.match(rf"{charged:.2f}"[:4], cell) for cell in cells), (charged, cells)
PY
