#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What a scenario expects of its run is judged, by `run` and by `trials`: each kind of bound holds and breaks, with the value,
# the time and the reason; exit status 3, behind 2 (nothing ran) and 1 (a client failed). JUnit XML is read by Python's parser.
# Under --strict each warning is an error, those of URDF files, too.
# Topics: expectations, failures, trials, metrics.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out"
cat >worker.py <<'PY'
import sys, time
for i in range(20):
    time.sleep(0.02)
    print("tcs-metric cycles", i, flush=True)
sys.exit(int(sys.argv[1]))
PY
cat >eyes.py <<'PY'
import json, socket
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 27641))
while True:
    s.recv(4096)
    s.sendto(b'{"force": [0, 1, 0]}', ("127.0.0.1", 27642))
PY
cat >world.yaml <<YAML
duration: 1s
dynamics: {gravity: [0, 0, -9.81]}
bodies: {ball: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, 10]}}
models: {cart: {urdf: $source_root/tests/models/pendulum.urdf, fixed_base: true}}
robots:
  r:
    clients:
      worker: {command: [python3, worker.py, "0"]}
      task: {command: [$build/bin/periodic_worker, "3000", "10000", "50"], class: periodic, priority: 60, deadline: 8ms}
      eyes: {command: [python3, eyes.py], class: periodic, priority: 50}
channels:
  eyes: {type: udp_json, sensors: {bodies: [ball], rate: 50, to: "127.0.0.1:27641"}}
  push: {type: udp_json, commands: {body: ball, listen: "127.0.0.1:27642", latency: 5ms}}
metrics: {height: {min: ball.z}}
YAML
run() {  # STATUS ARGUMENTS
  local status=0
  timeout 200 "$tcsim" run --accounting fixed "${@:2}" >said 2>&1 || status=$?
  ((status == $1)) || fail "run ${*:2} exits with $status, not $1: $(cat said)"
}
says() { grep -qE -- "$1" said || fail "nobody said '$1': $(cat said)"; }

cat world.yaml - >good.yaml <<'YAML'
expect:
  task: {misses: 0, response_p99: 8ms, activations: [40, null]}
  r/eyes: {lost: 0}
  chain eyes->push: {age_p99: [5ms, 9ms]}
  metric height: {min: [5.0, 5.2]}
  metric cycles: {max: 19, count: [20, 20]}
  metric r/worker/cycles: {last: 19}
  body ball: {z: [9.98, 10], vy: [-0.01, 1.1], until: 50ms}
  joint cart/hinge: {velocity: [-20, 20]}
  channel push: {force_y: 1}
  run: {virtual: [1s, 1s]}
YAML
run 0 good.yaml --junit good.xml
says '^14 of 14 expectations hold$'
# What a shortened run does not come to is not judged.
for shorter in --duration --stop-at; do
  run 0 good.yaml --set 'expect.body ball.until=1s' --set 'expect.body ball.from=600ms' \
    --set 'expect.task={misses: 0}' --set 'expect.run={drift: 1ms}' --set 'expect.metric cycles={max: 19}' \
    --set 'expect.metric r/worker/cycles={max: 19}' --set 'expect.metric height={min: [5, 10]}' "$shorter" 500ms
  says '^9 of 9 expectations hold$'
  says '^2 expectations begin only after the end that was asked for: not judged$'
done
cat >bad.yaml <<'YAML'
expect:
  task: {misses: 0, response_max: 1ms}
  worker: {misses: 5}
  chain eyes->push: {age_p99: 4ms}
  metric height: {min: [6, null]}
  metric nothing: {last: 1}
  body ball: {z: [8, 12]}
  body cart: {z: [0, 0], from: 2s}
YAML
# The task computes beyond its deadline; the others fall, and are unknown.
cat world.yaml bad.yaml >broken.yaml
run 3 broken.yaml --set 'robots.r.clients.task.deadline=2ms' --junit bad.xml --out bad
says '^0 of 8 expectations hold$'
[[ $(grep -c '^tcsim: not as expected: ' said) == 8 ]] || fail "not all were named: $(cat said)"
says 'broken.yaml:17: worker: misses is not known, expected at most 5: it has no deadline'
says 'task: misses was (49|50), expected at most 0, first at 0\.1[0-9]* s'
says 'ball: z was between 5\.0[0-9]* and 10, expected from 8 to 12, first left at 0\.640 s'
says 'cart: z is not known, expected from 0 to 0: the run has no value of it'
says 'metric nothing: last is not known, expected at most 1: nobody told a value of it'
says 'metric height: min was 5\.0[0-9]*, expected at least 6'
# The earliest is the first.
grep -m1 'not as expected' said | grep -q 'task: misses' || fail "the first was not named first: $(cat said)"
python3 - <<'PY' || fail "the files for programs"
import json
from xml.etree import ElementTree
good, bad = (ElementTree.parse(name).getroot() for name in ("good.xml", "bad.xml"))
assert good.tag == "testsuites" and good.get("failures") == "0" and good.get("tests") == "17", good.attrib
assert not good.findall(".//failure")
assert bad.find("testsuite").get("failures") == "8"
failed = {case.get("classname") + " " + case.get("name"): case.find("failure") for case in bad.iter("testcase")}
assert "z was between" in failed["body ball z from 8 to 12"].get("message")
assert failed["r/eyes does not fail"] is None
[ball] = [e for e in json.load(open("bad/summary.json"))["expectations"] if e["subject"] == "body ball"]
assert ball["first_time_ns"] == 640_000_000 and not ball["holds"] and ball["least"] == 8 and ball["largest"] == 10, ball
assert "height" in json.load(open("bad/summary.json"))["metrics"] and len(json.load(open("bad/summary.json"))["metrics"]) == 2
PY
# A client that failed comes before; a mistake before both. Expecting changes no body.
run 1 broken.yaml --set 'robots.r.clients.worker.command=[python3, worker.py, "4"]' --junit failed.xml
says 'not as expected'
grep -q 'r/worker ended at .* with exit status 4' failed.xml || fail "no case for the client: $(cat failed.xml)"
run 2 broken.yaml --set 'expect.task.mises=0'
says "did you mean 'misses'"
run 0 world.yaml --out without
run 0 good.yaml --out with
cmp without/bodies.csv with/bodies.csv || fail "expectations moved bodies"
cmp without/metrics.csv with/metrics.csv || fail "expectations are among the metrics"

# Over trials a bound holds in a share of them. The wall falls in with the seed: 2 of 4 seeds.
cat >draw.py <<'PY'
import sys
print("tcs-metric drawn", int(sys.argv[1]) % 2)
PY
cat >drawn.yaml <<'YAML'
duration: 1s
robots: {r: {clients: {draw: {command: [python3, draw.py, "${seed}"]}}}}
expect: {metric drawn: {last: 0, share: 0.5}}
YAML
trials() {  # STATUS ARGUMENTS
  local status=0
  timeout 200 "$tcsim" trials drawn.yaml --accounting fixed --trials 4 "${@:2}" >said 2>&1 || status=$?
  ((status == $1)) || fail "trials ${*:2} exit with $status, not $1: $(cat said)"
}
trials 0 --out half --junit half.xml
says '^1 of 1 expectations hold$'
trials 3 --out all --set 'expect.metric drawn.share=1' --junit all.xml
says 'drawn: last at most 0 held in 2 of 4 trials \(95 % confidence: 6\.8 % to 93\.2 % .*\); with seed 1 last was 1, expected at most 0'
trials 3 --out all --set 'expect.metric drawn.share=1'  # done already
python3 - <<'PY' || fail "JUnit of trials"
from xml.etree import ElementTree
assert ElementTree.parse("half.xml").getroot().get("failures") == "0"
[failure] = ElementTree.parse("all.xml").getroot().findall(".//failure")
assert "held in 2 of 4 trials" in failure.get("message")
PY

# Warnings: of the scenario, before the run; of the run, at its end.
run 0 good.yaml --set 'expect.body ball.from=2s' --set 'expect.body ball.until=3s' --check
says 'warning: .*begins after the end of the run'
run 2 good.yaml --set 'expect.body ball.from=2s' --set 'expect.body ball.until=3s' --strict --out never
says 'the scenario has a warning, and with --strict each is an error'
[[ ! -e never ]] || fail "something ran"
status=0
"$tcsim" check good.yaml --set 'expect.body ball.from=2s' --set 'expect.body ball.until=3s' --strict >said 2>&1 || status=$?
((status == 2)) || fail "check --strict exits with $status: $(cat said)"
sed 's/"drawn", /"drawn", "seen", /; s/tcs-metric drawn/tcs-metric/' draw.py >mute.py
printf 'print("tcs-metric drawn", 0)\n' >>mute.py
run 0 drawn.yaml --set 'robots.r.clients.draw.command=[python3, mute.py, "2"]'
says 'warning: '
run 3 drawn.yaml --set 'robots.r.clients.draw.command=[python3, mute.py, "2"]' --strict
says 'the run had a warning, and with --strict each is an error; the first: '
trials 3 --out mute --set 'robots.r.clients.draw.command=[python3, mute.py, "2"]' --strict
says 'trials had warnings \(4\), and with --strict each is an error; the first: seed 1: '
