#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A program of another vendor's DDS, Fast DDS, flies the drone of examples/hover by the scenario's topics: all samples, in
# order, when they were written. In both accountings; fixed runs repeat to the byte.
# Topics: dds, udp, determinism.
[[ -e /usr/include/fastdds/dds/domain/DomainParticipant.hpp ]] && type g++ >/dev/null 2>&1 || { echo "Fast DDS (libfastrtps-dev) was not found"; exit 77; }
out=$(mktemp -d)
# Whoever is ended by a signal, as its run's end does it, leaves what Fast DDS has shared.
forget_shared() { comm -13 <(sort <<<"$shared_at_start") <(ls /dev/shm | sort) | grep fastrtps | sed 's|^|/dev/shm/|' | xargs -r rm -f || true; }
trap 'forget_shared; rm -rf "$out"' EXIT
g++ -std=c++20 -O1 "$source_root/tests/programs/fast_dds_hover.cc" -lfastrtps -lfastcdr -o "$out/hover_dds"
cp "$source_root/examples/hover/hover_dds.yaml" "$out"
fly() {  # NAME OPTION...
  timeout 200 "$build/bin/in_own_network" "$tcsim" run "$out/hover_dds.yaml" --set robots.drone.clients.controller.dds=sockets \
    --set expect.controller=null --out "$out/$1" "${@:2}" \
    >"$out/said" 2>&1 || fail "$1: status $?: $(cat "$out/said" "$out/$1"/*.log)"
}
fly measured
for run in first second; do fly "$run" --accounting fixed; done
for run in measured first; do
  samples=$out/$run/drone-controller.out.log
  python3 - "$samples" "$run" <<'PY' || fail "$run: $(head -n 20 "$samples")"
import sys
samples = [tuple(map(int, line.split())) for line in open(sys.argv[1])]
assert len(samples) > 450, len(samples)
for (_, before, _, _), (_, after, _, _) in zip(samples, samples[1:]): assert after - before == 10_000_000, (before, after)
late = 0  # where it is measured the host may be busy: three of a hundred, and by less than three periods
for number, stamp, written, came in samples:
    assert written == stamp and 0 <= came - stamp < 30_000_000, (stamp, written, came)
    if number >= 5 and came - stamp >= 3_000_000: late += 1
assert late <= (0 if sys.argv[2] == "first" else 0.03 * len(samples)), late
assert sorted(came - stamp for _, stamp, _, came in samples)[len(samples) // 2] < 1_000_000
PY
done
for file in bodies.csv commands.csv dispatches.csv activations.csv topics.json drone-controller.out.log; do
  cmp "$out/first/$file" "$out/second/$file" || fail "fixed runs differ: $file"
done
