#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# 20 ms between two robots are pings of 40 ms. iperf3 finds by TCP the bandwidth that was set, and by
# UDP the loss. All by Debian's programs as they are. The same packets are lost in each run with one
# seed.
# Topics: network, tcp, udp, ordinary programs.
PATH=$PATH:/usr/sbin
command -v ping iperf3 python3 > /dev/null || exit 77
"$source_root/tests/scenario/can_have_networks.sh" || exit 77
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
run() {  # NAME, then what tcsim run is given besides
  "$tcsim" run "$scratch/$1.yaml" --out "$scratch/$2" "${@:3}" > "$scratch/$2.said" 2>&1 ||
    fail "$2: $(cat "$scratch/$2.said") $(cat "$scratch/$2"/*.log)"
}

cat > "$scratch/ping.yaml" << 'END'
duration: 150s
network: {latency: 20ms, links: [{from: prey, to: predator, loss: 0.1}]}
robots:
  predator: {clients: {ping: {command: [ping, -c, "1000", -i, "0.1", prey]}}}
  prey: {clients: {wait: {command: [sleep, "140"]}}}
END
for name in ping again; do run ping $name --accounting fixed; done
out="$scratch/ping/predator-ping.out.log"
python3 - "$out" << 'PY' || fail "$(tail -20 "$out")"
import re, sys
text = open(sys.argv[1]).read()
times = [float(t) for t in re.findall(r"time=([\d.]+) ms", text)]
assert 860 <= len(times) <= 940, len(times)
assert all(40 <= t <= 40.1 for t in times), (min(times), max(times))
PY
cmp "$out" "$scratch/again/predator-ping.out.log" || fail "other packets were lost the second time"
run ping other --accounting fixed --seed 2
cmp -s "$out" "$scratch/other/predator-ping.out.log" && fail "another seed loses the same packets"

cat > "$scratch/iperf.yaml" << 'END'
duration: 14s
network: {latency: 20ms, bandwidth: 10Mbit/s}
robots:
  predator: {clients: {client: {command: [iperf3, -c, prey, -p, "5000", -t, "10", -J], start: 500ms}}}
  prey: {clients: {server: {command: [iperf3, -s, -1, -p, "5000"]}}}
END
for name in tcp tcp_again; do run iperf $name --accounting fixed; done
python3 - "$scratch/tcp/predator-client.out.log" << 'PY' || fail "$(tail -40 "$scratch/tcp/predator-client.out.log")"
import json, sys
result = json.load(open(sys.argv[1]))
assert "error" not in result, result["error"]
# Of 1500 bytes 40 are TCP's and IP's. After slow start, which ends in a full queue; iperf3 counts by
# 128 kB.
rates = [i["sum"]["bits_per_second"] for i in result["intervals"][3:]]
mean = sum(rates) / len(rates)
assert 9.5e6 < mean < 9.95e6, rates
assert 9e6 < result["end"]["sum_received"]["bits_per_second"] < 9.74e6, result["end"]
PY
# What it also tells are the host's numbers: TCP_INFO's times, ports and processor time split up.
python3 - "$scratch/tcp/predator-client.out.log" "$scratch/tcp_again/predator-client.out.log" << 'PY' || fail "two runs of iperf3 differ"
import json, sys
def told(name):
    return [(i["sum"]["bytes"], i["sum"]["retransmits"], i["streams"][0]["snd_cwnd"])
            for i in json.load(open(name))["intervals"]]
one, two = map(told, sys.argv[1:])
assert one == two, (one, two)
PY

cat > "$scratch/udp.yaml" << 'END'
duration: 8s
network: {latency: 20ms, bandwidth: 10Mbit/s, links: [{from: predator, to: prey, loss: 0.01}]}
robots:
  prey: {clients: {server: {command: [iperf3, -s, -1, -p, "5000"]}}}
  predator:
    clients:
      client: {command: [iperf3, -c, prey, -p, "5000", -u, -b, 5M, -l, "500", -t, "5", -J], start: 500ms}
END
run udp udp
python3 - "$scratch/udp/predator-client.out.log" << 'PY' || fail "$(tail -30 "$scratch/udp/predator-client.out.log")"
import json, sys
result = json.load(open(sys.argv[1]))
assert "error" not in result, result["error"]
end = result["end"]["sum"]
assert end["packets"] > 5500, end
assert 0.5 < end["lost_percent"] < 1.6, end
PY
