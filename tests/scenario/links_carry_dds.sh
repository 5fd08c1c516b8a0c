#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# DDS between two robots takes the link's time, in shared memory as by sockets: a ping of ddsperf's,
# Debian's Cyclone DDS as it is, takes 40 ms where 20 ms are in between.
# Topics: network, dds.
command -v ddsperf python3 > /dev/null || exit 77
"$source_root/tests/scenario/can_have_networks.sh" || exit 77
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for way in endpoints sockets; do
  cat > "$scratch/$way.yaml" << END
duration: 14s
network: {latency: 20ms}
robots:
  predator: {clients: {ping: {dds: $way, command: [ddsperf, -D, "10", ping]}}}
  prey: {clients: {pong: {dds: $way, command: [ddsperf, -D, "12", pong]}}}
END
  for run in one two; do
    "$tcsim" run "$scratch/$way.yaml" --accounting fixed --out "$scratch/$way.$run" \
      > "$scratch/said" 2>&1 || fail "$way: $(cat "$scratch/said" "$scratch/$way.$run"/*.log)"
  done
  out="$scratch/$way.one/predator-ping.out.log"
  python3 - "$out" << 'PY' || fail "$way: $(cat "$scratch/said" "$scratch/$way.one"/*.log)"
import re, sys
text = open(sys.argv[1]).read()
# Halves of round trips in us: mean, least, median and so on, since the last line.
trips = re.findall(r"mean ([\d.]+)us min ([\d.]+)us 50% ([\d.]+)us", text)
assert len(trips) >= 6, text
for trip in trips[1:]:
    mean, least, median = (float(t) for t in trip)
    assert 20_000 <= least and median < 20_500 and mean < 20_500, trip
PY
  # But for the numbers of processes, and what it tells of its memory: these are the host's.
  for run in one two; do
    sed -E '/rss:/d; s/\[[0-9]+\]|:[0-9]+//g' "$scratch/$way.$run/predator-ping.out.log" > "$scratch/$run"
  done
  cmp "$scratch/one" "$scratch/two" || fail "$way: the runs differ"
done
