#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What cannot be run is refused with one sentence that says what and how to mend it, and exit status 2.
# Topics: failures.
out=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$out"' EXIT
chmod 755 "$out"

refused() {  # PATTERN COMMAND...
  local pattern=$1 status=0
  shift
  timeout 200 "$@" >"$out/stdout" 2>"$out/stderr" || status=$?
  sed -i '/^tcsim: other runs of tcsim have/d' "$out/stderr"  # they may
  ((status == 2)) || fail "exit status $status instead of 2: $*"
  [[ $(wc -l <"$out/stderr") == 1 ]] || fail "not one line: $(cat "$out/stderr")"
  grep -Eq "^tcsim: .*$pattern" "$out/stderr" || fail "$(cat "$out/stderr")"
}

cat >"$out/scenario.yaml" <<'YAML'
duration: 1s
dynamics: {}
bodies: {ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
robots: {r: {clients: {idle: {command: [sleep, "1"]}}}}
channels: {thrust: {type: udp_json, commands: {body: ship, listen: "127.0.0.1:27431"}}}
YAML
python3 -c '
import socket, time
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM); s.bind(("127.0.0.1", 27431))
print("bound", flush=True); time.sleep(1000)' >"$out/holder" &
for _ in $(seq 1000); do grep -q bound "$out/holder" && break; sleep 0.1; done
refused 'port 27431 on 127.0.0.1 is taken' "$tcsim" run "$out/scenario.yaml" --out "$out/run"

touch "$out/file"
refused "'$out/file'.*--out" "$tcsim" run "$out/scenario.yaml" --out "$out/file"
refused '\{measured,fixed\}' "$tcsim" exec --accounting guessed -- true
refused 'is not positive' "$tcsim" run "$out/scenario.yaml" --drift 0ms
refused 'call-cost.*is not positive' "$tcsim" exec --call-cost 0ns -- true
refused "no command 'rnu'; did you mean 'run'" "$tcsim" rnu "$out/scenario.yaml"
refused "run has no option --durations; did you mean '--duration'" "$tcsim" run --durations=3s "$out/scenario.yaml"
mkdir "$out/empty"
refused 'scenario.yaml: cannot be read' env -C "$out/empty" "$tcsim" run
refused "'a/b' cannot be used as a name" "$tcsim" new a/b
refused "no client 'r/idel'; did you mean 'r/idle'" "$tcsim" run --gdb r/idel "$out/scenario.yaml"
refused 'nowhere.yaml' "$tcsim" run "$out/nowhere.yaml"
refused "no folder '$out/nowhere'" "$tcsim" topics "$out/nowhere"
mkdir "$out/no-topics"
refused "'$out/no-topics' has no topics.json" "$tcsim" topics "$out/no-topics"

mkdir "$out/busy"
flock --no-fork "$out/busy" sleep 1000 &
for _ in $(seq 2000); do flock -n "$out/busy" true || break; sleep 0.05; done
refused "another run writes to the folder '$out/busy'.*--out" "$tcsim" run "$out/scenario.yaml" --out "$out/busy"

# Where not even a sentence can be written the status still says it.
status=0; timeout 200 "$tcsim" run "$out/nowhere.yaml" 2>/dev/full || status=$?
((status == 2)) || fail "exit status $status instead of 2 with a stderr that is full"
refused 'not everything could be printed: No space left' sh -c '"$1" doctor --json >/dev/full' sh "$tcsim"

# What an earlier run has left is not written over by one that cannot begin.
mkdir "$out/earlier"
echo kept >"$out/earlier/bodies.csv"
refused 'port 27431 on 127.0.0.1 is taken' "$tcsim" run "$out/scenario.yaml" --out "$out/earlier"
[[ $(cat "$out/earlier/"*) == kept ]] || fail "an earlier run's results were written over: $(ls "$out/earlier")"

# Nor are its clients' logs removed by one that cannot; by one that can they are, and nothing else is.
sed '/^channels/d; s/idle:/old:/' "$out/scenario.yaml" >"$out/old.yaml"
sed 's/old:/new:/' "$out/old.yaml" >"$out/new.yaml"
run() { timeout 200 "$tcsim" run "$1" --out "$out/logs" >"$out/said" 2>&1 || fail "$(cat "$out/said")"; }
run "$out/old.yaml"
echo mine >"$out/logs/mine.out.log"
refused 'port 27431 on 127.0.0.1 is taken' "$tcsim" run "$out/scenario.yaml" --out "$out/logs"
[[ -e $out/logs/r-old.out.log ]] || fail "a run that could not begin has removed logs"
run "$out/new.yaml"
[[ ! -e $out/logs/r-old.out.log && -e $out/logs/r-new.err.log && -e $out/logs/mine.out.log ]] || fail "logs: $(ls "$out/logs")"

# The rest needs root.
((EUID == 0)) || exit 0
sed 's/27431/27435/' "$out/scenario.yaml" >"$out/small.yaml"
if mkdir "$out/small" && mount -t tmpfs -o size=64k none "$out/small" 2>/dev/null; then
  trap 'umount "$out/small"; kill $(jobs -p) 2>/dev/null || true; rm -rf "$out"' EXIT
  refused 'cannot be made: .*No space left.*--out' "$tcsim" run "$out/small.yaml" --record --out "$out/small/run"
fi
# A processor whose TSC is no clock.
sed 's/nonstop_tsc//; s/constant_tsc//' /proc/cpuinfo >"$out/cpuinfo"
elsewhere=(unshare -m bash -c 'mount --bind "$0" /proc/cpuinfo && exec "$@"' "$out/cpuinfo")
if "${elsewhere[@]}" true 2>/dev/null; then
  refused 'TSC changes its rate or stops.*`--accounting fixed`' "${elsewhere[@]}" "$tcsim" run "$out/small.yaml" --out "$out/tsc"
  "${elsewhere[@]}" "$tcsim" run "$out/small.yaml" --accounting fixed --out "$out/tsc" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
fi
