# For the tests of `tcsim trials`: a scenario in "$out" whose client computes and pushes as its seed
# says, and exits 1 for the seed in $FAILING_SEED. Everything of it has "$mark" in its command line.
out=$(mktemp -d)
mark="tcs_mark_$$"
trap 'pkill -9 -f "$mark" || true; rm -rf "$out"' EXIT
cat >"$out/pilot.py" <<'PY'
import json, os, random, socket, sys
seed = sys.argv[1]
if os.environ.get("FAILING_SEED") == seed:
    sys.exit("this seed is not for me")
random.seed(seed)
eyes = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
eyes.bind(("127.0.0.1", 27440))
while True:
    eyes.recv(65536)
    push = [random.random() for _ in range(random.randrange(100, 3000))]
    eyes.sendto(json.dumps({"force": push[:3]}).encode(), ("127.0.0.1", 27441))
PY
cat >"$out/scenario.yaml" <<YAML
duration: 3s
dynamics: {}
bodies: {ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
robots: {r: {clients: {pilot: {command: [python3, pilot.py, "\${seed}", $mark]}}}}
channels:
  eyes: {type: udp_json, sensors: {bodies: [ship], rate: 100, to: "127.0.0.1:27440"}}
  thrust: {type: udp_json, commands: {body: ship, listen: "127.0.0.1:27441"}}
YAML

same() {  # FOLDER FOLDER: of two runs
  cmp "$1/bodies.csv" "$2/bodies.csv" || fail "body states of $1 and $2 differ"
  cmp "$1/trace.json" "$2/trace.json" || fail "schedules of $1 and $2 differ"
}

nothing_is_left() {
  local left=""
  for _ in $(seq 600); do
    left=$(pgrep -af "$mark|$out" | grep -v "^$$ " || true)
    [[ -z $left ]] && return
    sleep 0.1
  done
  fail "$1: there is still: $left"
}
