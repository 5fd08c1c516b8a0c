#!/usr/bin/env bash
# ddsperf.sh BUILD sockets|endpoints [without_rights|in_container]: Debian's ddsperf, on two robots: each process ends by
# itself with status 0 after its stated virtual duration, having seen its peer and what it had to. Also as somebody
# without any rights, from copies that everybody may read, and where what Docker refuses is refused.
set -euo pipefail
build=$1 variant=$2 rights=${3:-}
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
run=("$build/bin/in_own_network" "$build/bin/tcsim")
if [[ -n $rights ]]; then
  ((EUID == 0)) || exit 77  # to have an own network, and give it up
  chmod 777 "$work"
  source "$(dirname -- "${BASH_SOURCE[0]}")/../as_nobody.sh"
  install_for_everybody "$build" "$work" in_container_profile
  contained=()
  [[ $rights != in_container ]] || contained=("$work/bin/in_container_profile")
  run=("$build/bin/in_own_network" "${nobody[@]}" "${contained[@]}" "$work/bin/tcsim")
fi
export CYCLONEDDS_URI='<CycloneDDS><Domain id="any"><General>
  <Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces>
</General></Domain></CycloneDDS>'
dds=", dds: $variant"

# between SECONDS 'ARGUMENTS OF THE FIRST' 'OF THE SECOND': their words come into $first and $second.
between() {
  local seconds=$1 one two
  one=$(printf '"%s", ' $2) two=$(printf '"%s", ' $3)
  cat >"$work/scenario.yaml" <<END
duration: 1h
robots:
  left: {clients: {first: {command: [ddsperf, -D$seconds, "-Qminmatch:1", $one]$dds}}}
  right: {clients: {second: {command: [ddsperf, -D$seconds, "-Qminmatch:1", $two]$dds}}}
END
  rm -rf "$work/out"
  "${run[@]}" run "$work/scenario.yaml" --out "$work/out" \
    >"$work/said" 2>&1 || fail "'$2' with '$3': $(cat "$work/said" "$work"/out/*.log)"
  python3 - "$work/out/summary.json" "$seconds" <<'END' || fail "'$2' with '$3': $(cat "$work"/out/*.log)"
import json, sys
seconds = float(sys.argv[2])
for name, client in json.load(open(sys.argv[1]))["clients"].items():
    assert client["wait_status"] == 0, f"{name} ended with {client['wait_status']}"
    ended = client["ended_at_ns"] / 1e9
    assert seconds <= ended < seconds + 0.5, f"{name} ended at {ended} s"
END
  [[ -z $rights ]] || grep -q 'SCHED_FIFO is not permitted here' "$work/said" || fail 'it had the right'
  [[ $rights != in_container ]] || grep -q 'pidfd_getfd is refused here' "$work/said" || fail 'it was not refused'
  first=$(cat "$work/out/left-first.out.log") second=$(cat "$work/out/right-second.out.log")
}

says() { grep -Eq -- "$2" <<<"$1" || fail "it does not say '$2': $1"; }

# What ddsperf computes is the host's: until the two have met, and its reports may be some ms late and count some more or less.
between 3 'pong' '-Qroundtrips:270 ping 100Hz'
says "$second" ' 2\.0[0-4].* cnt (9[5-9]|10[0-5])$'
between 3 'pong waitset' '-Qroundtrips:270 ping 100Hz waitset'
says "$second" ' 2\.0[0-4].* cnt (9[5-9]|10[0-5])$'
between 3 '-Qsamples:2700 sub' 'pub 1kHz size 256'
says "$first" ' 2\.0[0-4].* lost 0 delta (9[5-9][0-9]|10[0-4][0-9]) lost 0 '
between 3 '-Qsamples:2700 sub polling' 'pub 1kHz size 16k'
says "$first" ' 2\.0[0-4].* lost 0 delta (9[5-9][0-9]|10[0-4][0-9]) lost 0 '
# As fast as they can, which are some 100,000 small samples in a fifth of a second (of 16 KB fewer than 1,000 have been seen) and
# 1,000 round trips in a tenth: far more than is asked for, as it is the host that decides. (Pings begin after a second.)
between 1.1 'pong' '-Qroundtrips:200 ping'
between 1.1 'pong waitset' '-Qroundtrips:200 ping waitset'
between 0.2 '-Qsamples:1000 sub' 'pub size 64'
between 0.2 '-Qsamples:200 sub waitset' 'pub size 16k'
