#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Figures of one's own. What programs print as `tcs-metric NAME VALUE [TIME]` counts at the time of the write, or at theirs,
# buffered, in pieces, from threads, to their very end; their output stays as it is. What a scenario names over bodies and
# channels is what a closed form says. Neither changes the run. All of it is in the summary, in metrics.csv, in the report, and in trials.json.
# Topics: metrics, report, trials, determinism, physics.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out"

cat >flushed.py <<'PY'
import os, threading, time
for i in range(20):
    time.sleep(0.01)
    now = time.monotonic()
    print("tcs-metric", "at_write", i, flush=True)
    print("tcs-metric", "at_own", i, now, flush=True)
print("see: tcs-metric at_write 99")
print("tcs-metric at_write 3,5", flush=True)
print("tcs-metric at_write", flush=True)
os.write(1, b"tcs-me")
time.sleep(0.02)
os.write(1, b"tric pieces 7\n")
pieces = [b"tcs-metric ", b"threads ", b"%d" % 8, b"\n"]
for piece in pieces:
    writer = threading.Thread(target=os.write, args=(1, piece))
    writer.start()
    writer.join()
PY
cat >buffered.py <<'PY'
import signal, sys, time
signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
for i in range(10):
    time.sleep(0.01)
    print("tcs-metric buffered", i)
    print(f"tcs-metric buffered_own {i} {time.time_ns()}")
sys.stdout.flush()
print("tcs-metric at_write", 1000)
time.sleep(100)
PY
cat >eyes.py <<'PY'
import json, socket
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 27450))
while True:
    reading = json.loads(s.recv(4096))
    if reading["time"] == 0.5: s.sendto(b'{"force": [0, 2, 0]}', ("127.0.0.1", 27451))
    print("tcs-metric seen", reading["bodies"]["ball"]["position"][2], reading["time"], flush=True)
PY
cat >world.yaml <<'YAML'
duration: 1s
dynamics: {gravity: [0, 0, -9.81]}
bodies:
  ball: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, 10], linear_velocity: [1, 0, 0]}
  stone-1: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [3, 4, 10]}
robots:
  r:
    clients:
      flushed: {command: [python3, flushed.py], environment: {PYTHONUNBUFFERED: ""}}
      buffered: {command: [python3, buffered.py], environment: {PYTHONUNBUFFERED: ""}}
      eyes: {command: [python3, eyes.py], start: 0s}
channels:
  eyes: {type: udp_json, sensors: {bodies: [ball], rate: 10, to: "127.0.0.1:27450"}}
  push: {type: udp_json, commands: {body: ball, listen: "127.0.0.1:27451", latency: 20ms}}
YAML
cat >metrics.yaml <<'YAML'
metrics:
  height: {last: ball.z}
  error: {rms: ball.z - 9.0, from: 0.2s, until: 0.6s}
  fine: {mean: 2 * ball.vz / 4, every: 1ms}
  below: {first_time_when: ball.z < 9}
  below_fine: {first_time_when: ball.z<9, every: 1ms}
  below_never: {first_time_when: ball.z < -9}
  apart: {min: distance(ball, stone-1), until: 0.5s}
  travel: {max: norm(ball.x, ball.z-10), until: 0.5s}
  sensed: {last: eyes.position.z}
  pushed: {max: push.force_y}
YAML
cat world.yaml metrics.yaml >fall.yaml
said() { timeout 200 "$tcsim" "$@" >said 2>&1 || fail "$(cat said)"; }
for run in first second; do said run fall.yaml --accounting fixed --out $run; done
says() { grep -q -- "$1" said || fail "nobody said '$1': $(cat said)"; }
says '^height  *scenario  *last 5.095  *101 '
says '^below  *scenario  *0.460 s '
says '^below_never  *scenario  *never '
says "r/flushed: a line that begins with tcs-metric has the value '3,5'.*r-flushed.out.log:42)"
[[ $(grep -c 'a line that begins with tcs-metric' said) == 1 ]] || fail "it said more than once what is no metric: $(cat said)"
cmp first/metrics.csv second/metrics.csv || fail "metrics.csv differs between two fixed runs"
# To measure changes nothing.
said run world.yaml --accounting fixed --out without
for file in bodies.csv commands.csv output.csv activations.csv r-flushed.out.log r-buffered.out.log r-eyes.out.log; do
  cmp first/$file without/$file || fail "$file differs without the scenario's metrics"
done
grep -q '^tcs-metric at_write 3,5$' first/r-flushed.out.log || fail "a program's output is not as it was"

python3 - <<'PY' || fail "the metrics are not what they should be"
import csv, json, math
summary = json.load(open("first/summary.json"))
metrics = summary["metrics"]
rows = list(csv.DictReader(open("first/metrics.csv")))
of = lambda name, source=None: [(int(r["time_ns"]), float(r["value"])) for r in rows if r["name"] == name and source in (None, r["from"])]
near = lambda a, b: abs(a - b) <= 1e-9 * max(1, abs(b))

# A dropped body, at the instants 0, 10 ms, ...
z = lambda t: 10 - 9.81 / 2 * t * t
grid = [i / 100 for i in range(101)]
assert near(metrics["height"]["last"], z(1)) and metrics["height"]["count"] == 101, metrics["height"]
assert near(metrics["height"]["mean"], sum(map(z, grid)) / 101), metrics["height"]
errors = [z(t) - 9 for t in grid[20:61]]
assert near(metrics["error"]["rms"], math.sqrt(sum(e * e for e in errors) / 41)), metrics["error"]
assert metrics["error"]["count"] == 41 and metrics["error"]["asked"] == "rms", metrics["error"]
assert near(metrics["fine"]["mean"], -9.81 / 4) and metrics["fine"]["count"] == 1001, metrics["fine"]
assert metrics["below"]["first_time_ns"] == 460_000_000 and metrics["below_fine"]["first_time_ns"] == 452_000_000, metrics["below"]
assert near(metrics["below"]["mean"], 55 / 101) and metrics["below_never"]["first_time_ns"] is None, metrics["below"]
assert near(metrics["apart"]["min"], math.hypot(2.5, 4)), metrics["apart"]
assert near(metrics["travel"]["max"], math.hypot(0.5, 9.81 / 8)), metrics["travel"]
# In the table as often as in bodies.csv.
assert [t for t, _ in of("fine")] == [10_000_000 * i for i in range(101)], of("fine")[:5]
bodies = [float(r["z_m"]) for r in csv.DictReader(open("first/bodies.csv")) if r["body"] == "ball"]
assert [v for _, v in of("height")] == bodies
# A channel's values are the newest: of a sensor of 10 Hz, and of a command from when it acts on.
assert near(metrics["sensed"]["last"], z(1)) and metrics["sensed"]["count"] == 101, metrics["sensed"]
assert [near(v, z(math.floor(t / 1e8) / 10)) for t, v in of("sensed")] == [True] * 101
pushed, commands = of("pushed"), list(csv.DictReader(open("first/commands.csv")))
acts = min(int(c["acts_ns"]) for c in commands)
assert metrics["pushed"]["max"] == 2 and all(t > acts for t, _ in pushed) and pushed[0][0] - acts <= 10_000_000, (acts, pushed[0])

# What programs print, when it is written; or when they say. Both are of the same moment, up to the end of the turn.
written, own = of("at_write", "r/flushed"), of("at_own")
assert [v for _, v in written] == [v for _, v in own] == list(range(20)), (written, own)
assert all(0 <= w - o <= 2_000_000 for (w, _), (o, _) in zip(written, own)), (written, own)
assert all(b[0] - a[0] >= 9_000_000 for a, b in zip(own, own[1:])), own
assert metrics["r/flushed/at_write"]["count"] == 20 and metrics["r/flushed/at_write"]["mean"] == 9.5
# Buffered, all at once, but with the times that they have themselves; the last at the program's end.
[(flush_ns, _)] = {(t, 0) for t, _ in of("buffered")}
assert len(of("buffered")) == 10 and all(t < flush_ns for t, _ in of("buffered_own")[:9]), of("buffered")
assert len({t for t, _ in of("buffered_own")}) == 10
assert of("at_write", "r/buffered") == [(1_000_000_000, 1000.0)], of("at_write", "r/buffered")
assert metrics["r/buffered/at_write"]["last"] == 1000
# In pieces: when the line's end was there.
[(pieces_ns, seven)] = of("pieces")
assert seven == 7 and pieces_ns - written[-1][0] >= 20_000_000, (pieces_ns, written[-1])
assert metrics["threads"]["last"] == 8 and metrics["threads"]["from"] == "r/flushed"
# The time of a reading is one, too.
assert [t for t, _ in of("seen")][-3:] == [700_000_000, 800_000_000, 900_000_000] and all(near(v, z(t * 1e-9)) for t, v in of("seen")), of("seen")
PY

# On the page, and of trials at one place.
said report first --out page.html
grep -q '<figure id="metrics">' page.html || fail "the page has no curves of the metrics"
grep -q '>below</th><td>scenario</td>' page.html || fail "the page has no table of the metrics"
said trials fall.yaml --duration 0.5s --trials 2 --jobs 1 --accounting fixed --out trials
python3 - <<'PY' || fail "trials.json lacks the metrics"
import json
results = json.load(open("trials/trials.json"))["results"]
assert [result["folder"] for result in results] == ["seed-0001", "seed-0002"], results
for result in results:
    metrics = json.load(open(f"trials/{result['folder']}/summary.json"))["metrics"]
    for name, metric in metrics.items():
        assert metric["last"] is None or result["measures"][name + ".last"] == metric["last"], (name, result)
PY
said trials fall.yaml --duration 0.5s --trials 2 --jobs 1 --accounting fixed --out trials

# What there is not is said before the run.
sed 's/last: ball.z/last: bal.z/' fall.yaml >wrong.yaml
! "$tcsim" run wrong.yaml --out wrong >said 2>&1 || fail "it ran"
says "wrong.yaml:[0-9]*: metrics.height.last: there is no quantity 'bal.z'; did you mean 'ball.z'?"
