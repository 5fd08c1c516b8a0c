#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Debian's ROS 1, a master, a publisher, a subscriber that measures rates and a recorder, talks over
# TCP and XML-RPC in Python and C++: half a minute of it at exactly the rate that was asked for.
# Topics: ros, tcp, recording, timers.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/session.sh" <<'SESSION'
export ROS_HOME=$PWD ROS_MASTER_URI=http://127.0.0.1:27433 ROS_HOSTNAME=127.0.0.1 PYTHONUNBUFFERED=1
roscore -p 27433 >core.log 2>&1 & core=$!
until rostopic list >/dev/null 2>&1; do sleep 0.2; done
timeout -s INT 30 rostopic hz /chatter >hz.log 2>&1 & hz=$!
timeout -s INT 30 rosbag record -O chatter.bag /chatter >record.log 2>&1 & record=$!
timeout -s INT 32 rostopic pub -r 10 /chatter std_msgs/String hello >publish.log 2>&1
wait "$hz" "$record"
kill -INT "$core"
wait "$core"
SESSION
(cd "$out" && "$tcsim" exec -- bash session.sh) >"$out/said" 2>&1 || true
/usr/bin/python3 - "$out" <<'PY' || fail "$(cat "$out/said" "$out"/*.log)"
import re, sys
import rosbag
out = sys.argv[1]
text = open(out + "/hz.log").read()
rates = [float(rate) for rate in re.findall(r"average rate: (\S+)", text)]
windows = [int(window) for window in re.findall(r"window: (\d+)", text)]
least, most = (float(x) for x in re.findall(r"min: (\S+)s max: (\S+)s", text)[-1])
# What Python takes to start, and once for a message, is the host's: some messages more or less, and one that is late.
assert len(rates) >= 20 and len(windows) == len(rates) and abs(rates[-1] - 10) < 0.02, rates
assert all(abs(1 / rate - 0.1) * window < 0.05 for rate, window in zip(rates, windows)), (rates, windows)
assert 0.05 <= least and most <= 0.15, (least, most)
with rosbag.Bag(out + "/chatter.bag") as bag:
    times = [at.to_nsec() for _, _, at in bag.read_messages(topics=["/chatter"])]
intervals = [after - before for before, after in zip(times, times[1:])]
assert 240 <= len(times) <= 300, len(times)
assert sum(95e6 < interval < 105e6 for interval in intervals) >= 0.97 * len(intervals), sorted(intervals)
assert 50e6 < min(intervals) and max(intervals) < 150e6, (min(intervals), max(intervals))
PY
