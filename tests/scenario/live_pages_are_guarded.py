"""The checks of live_pages_are_guarded.sh."""
import os
import re
import socket
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

from live import PATIENCE, LiveRun

TCSIM, SCENARIO, OUT = sys.argv[1:]


def refused(run, what, status=403):
    answer, content = run.ask(**what)
    assert answer == status and content == b"", (what, answer, content[:200])


def raw(run, request, most=1 << 20):
    """What the server says to these bytes, and how it leaves."""
    with socket.create_connection(("127.0.0.1", run.port), timeout=PATIENCE) as connection:
        try:
            connection.sendall(request)
        except (BrokenPipeError, ConnectionResetError):
            pass
        answer = b""
        try:
            while len(answer) < most and (some := connection.recv(65536)):
                answer += some
        except ConnectionResetError:
            pass
        return answer


def tokens(run):
    for token in ("", run.token[:-1], run.token + "0", run.token[:-1] + ("0" if run.token[-1] != "0" else "1"),
                  run.token.upper() + "x", "%00" * 32, "../" + run.token):
        for path in (f"/{token}/", f"/{token}/news", f"/{token}"):
            refused(run, {"path": path})
            refused(run, {"path": path, "method": "POST", "body": b"go"})
    refused(run, {"path": "/"})
    refused(run, {"path": f"/{run.token}"})


def hosts(run):
    """As a page would ask whose own name was made to stand for this machine."""
    for host in ("evil.example", f"evil.example:{run.port}", f"127.0.0.1:{run.port + 1}", f"192.0.2.7:{run.port}", "",
                 [f"127.0.0.1:{run.port}", f"evil.example:{run.port}"]):
        refused(run, {"rest": "news", "headers": {"Host": host}})
    assert run.ask("news", headers={"Host": f"localhost:{run.port}"})[0] == 200


def origins(run):
    for origin in ("http://evil.example", "null", f"http://127.0.0.1:{run.port + 1}", f"https://127.0.0.1:{run.port}",
                   f"http://localhost:{run.port}"):
        refused(run, {"rest": "control", "body": b"go", "headers": {"Origin": origin}})
        refused(run, {"rest": "news", "headers": {"Origin": origin}})
    own = {"Origin": f"http://127.0.0.1:{run.port}"}
    assert run.ask("control", b"stand", headers=own)[0] == 200


def garbage(run):
    for words in (b"", b"go away", b"step", b"step -1", b"step 9999999999999999999", b"pace nan", b"\x00\xff", b"step 1;go"):
        status, content = run.ask("control", words)
        assert status == 400 and content == b"", (words, status)
    assert run.ask("control", b"x" * 257)[0] == 413
    assert run.ask("control", b"go" * 500_000)[0] == 413
    for what in ({"rest": "nothing"}, {"rest": "../news"}, {"rest": "news", "method": "DELETE"}, {"rest": "", "method": "PUT"}):
        refused(run, what, 404)
    requests = (b"\r\n\r\n", b"GET\r\n\r\n", b"\x16\x03\x01\x02\x00" * 100, b"GET / HTTP/9.9\r\n\r\n",
                b"GET /" + b"a" * 100_000 + b" HTTP/1.1\r\n\r\n",
                b"GET / HTTP/1.1\r\nHost: " + b"b" * 100_000 + b"\r\n\r\n")
    # All at once, for the server has two seconds of patience with each.
    with ThreadPoolExecutor(len(requests)) as askers:
        for answer in askers.map(lambda request: raw(run, request), requests):
            assert answer == b"" or re.match(rb"HTTP/1\.1 4\d\d ", answer), answer[:200]
            assert run.token.encode() not in answer
    # Nonsense for numbers is as if there were none.
    assert run.ask("news?generation=-1&moments=zzz&said=99999999999999999999&slices=")[0] == 200


def headers(run):
    """Other pages get nothing of it, and it is kept nowhere."""
    answer = raw(run, f"GET /{run.token}/news HTTP/1.1\r\nHost: 127.0.0.1:{run.port}\r\nConnection: close\r\n\r\n".encode())
    head = answer.split(b"\r\n\r\n")[0].lower()
    assert b"access-control" not in head
    for line in (b"cache-control: no-store", b"x-content-type-options: nosniff", b"referrer-policy: no-referrer",
                 b"cross-origin-resource-policy: same-origin", b"frame-ancestors 'none'"):
        assert line in head, head


def a_flood(run):
    """More than the server has threads, which hold on and say nothing: others get their turn once these are left."""
    held = [socket.create_connection(("127.0.0.1", run.port)) for _ in range(30)]
    for one in held:
        one.sendall(b"GET /")
    assert run.ask("news")[0] == 200
    for one in held:
        one.close()


def listens_on_this_machine_alone(run):
    server = subprocess.run(["pgrep", "-P", str(run.process.pid), "-x", "tcsim-view"], capture_output=True, text=True).stdout.strip()
    inodes = set()
    for fd in os.listdir(f"/proc/{server}/fd"):
        try:
            what = os.readlink(f"/proc/{server}/fd/{fd}")
        except FileNotFoundError:
            continue  # a connection that has been closed since
        if what.startswith("socket:"):
            inodes.add(what[8:-1])
    listening = []
    for table in ("tcp", "tcp6"):
        with open(f"/proc/{server}/net/{table}") as file:
            rows = [line.split() for line in file.readlines()[1:]]
        listening += [row[1] for row in rows if row[9] in inodes and row[3] == "0A"]
    assert listening == [f"0100007F:{run.port:04X}"], listening
    # At ordinary priority, and not where the run is bound to.
    assert os.sched_getscheduler(int(server)) == os.SCHED_OTHER
    assert os.sched_getaffinity(int(server)) == os.sched_getaffinity(0)


with LiveRun(TCSIM, SCENARIO, f"{OUT}/run", "--duration", "1s", "--pause") as run:
    run.stands_at(0)
    for check in (tokens, hosts, origins, garbage, headers, a_flood, listens_on_this_machine_alone):
        check(run)
        status = run.status()
        assert status["stage"] == "stands" and status["now"] == 0, (check.__name__, status)
        print(check.__name__, flush=True)
    run.tell("go")
    run.end()
