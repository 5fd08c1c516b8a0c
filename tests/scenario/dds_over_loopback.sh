#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Cyclone DDS, two processes over UDP: nothing is lost, each virtual second has what it should, and
# under fixed accounting two runs are the same.
# Topics: dds, udp, determinism.
export CYCLONEDDS_URI='<CycloneDDS><Domain id="any"><General><Interfaces>
  <NetworkInterface name="lo" multicast="true"/></Interfaces></General></Domain></CycloneDDS>'
both() {
  # In a network of their own: by sockets they would meet other tests' programs, whose messages take time, too.
  "$build/bin/in_own_network" "$tcsim" exec --dds sockets --accounting "$1" -- \
    bash -c "ddsperf -D 4 $2 & ddsperf -D 3.5 $3; wait" 2>/dev/null
}
# How much earlier the one program is up than the other is the host's where that is measured.
at='3\.00.' total='299|300' each=100
for accounting in fixed measured; do
  [[ $accounting == fixed ]] || at='3\.0..' total='29[0-9]|300|301' each='99|100|101'
  said=$(both "$accounting" sub 'pub 100Hz size 64')
  grep -Eq "$at .*total ($total) lost 0 delta ($each) lost 0" <<<"$said" || fail "$accounting: $said"
  said=$(both "$accounting" pong 'ping 100Hz')
  grep -Eq "$at .*mean .* cnt ($each)\$" <<<"$said" || fail "$accounting: $said"
done
# What a computer says of its memory is not virtual, what it says of its time is.
times() { sed '/rss:/d; s/^\[[0-9]*\]//; s/vm:[0-9]*//' | LC_ALL=C sort; }
first=$(both fixed pong 'ping 100Hz' | times)
second=$(both fixed pong 'ping 100Hz' | times)
[[ $first == "$second" ]] || fail "two fixed runs differ: $(diff <(echo "$first") <(echo "$second"))"
