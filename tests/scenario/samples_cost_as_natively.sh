#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# DDS samples in shared memory are charged what Cyclone and the kernel would take for them: by the list of prices of the
# robot's computer, to the nanosecond, for each process that reads; the sample is late by as much; a computer that is full
# with samples is full; what programs compute themselves is charged as ever; and runs of set costs repeat.
# Topics: accounting, dds.
type idlc gcc >/dev/null 2>&1 || exit 77
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out"
cat >Bytes.idl <<'IDL'
module T { @final struct Bytes { unsigned long number; sequence<octet> data; }; };
IDL
cat >node.c <<'C'
// node write COUNT PERIOD_US READERS | node read COUNT: 600 bytes each.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "Bytes.h"
#include "dds/dds.h"
static long long cpu(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return t.tv_sec * 1000000000LL + t.tv_nsec;
}
int main(int argc, char** argv) {
  const int count = atoi(argv[2]);
  dds_entity_t participant = dds_create_participant(0, NULL, NULL);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1000);
  dds_entity_t topic = dds_create_topic(participant, &T_Bytes_desc, "bytes", NULL, NULL);
  if (argc > 3) {
    dds_entity_t writer = dds_create_writer(participant, topic, qos, NULL);
    dds_publication_matched_status_t matched = {0};
    while ((int)matched.current_count < atoi(argv[4])) {
      dds_sleepfor(DDS_MSECS(10));
      dds_get_publication_matched_status(writer, &matched);
    }
    dds_sleepfor(DDS_MSECS(100));
    T_Bytes sample = {0};
    sample.data._length = sample.data._maximum = 600;
    sample.data._buffer = calloc(1, 600);
    const long long begun = cpu();
    for (int i = 0; i < count; ++i) {
      dds_sleepfor(DDS_USECS(atoi(argv[3])));
      sample.number = i;
      if (dds_write(writer, &sample) != 0) return 1;
    }
    printf("cpu %lld\n", (cpu() - begun) / count);
    fflush(stdout);
    dds_sleepfor(DDS_SECS(3));
    return 0;
  }
  dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL), set = dds_create_waitset(participant);
  dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
  dds_waitset_attach(set, reader, 0);
  for (int had = 0; had < count;) {
    dds_waitset_wait(set, NULL, 0, DDS_SECS(20));
    void* samples[1] = {NULL};
    dds_sample_info_t info[1];
    while (dds_take(reader, samples, info, 1, 1) == 1) {
      printf("late %lld\n", (long long)(dds_time() - info[0].source_timestamp));
      dds_return_loan(reader, samples, 1);
      ++had;
    }
  }
  return 0;
}
C
idlc -l c Bytes.idl
gcc -O1 -Wall -Werror node.c Bytes.c -lddsc -o node
list() {  # FILE SEND FURTHER RECEIVE, of whatever size
  local part="{send: [$2, $2, $2, $2], send_further: [$3, $3, $3, $3], receive: [$4, $4, $4, $4]}"
  local none="{send: [0, 0, 0, 0], send_further: [0, 0, 0, 0], receive: [0, 0, 0, 0]}"
  printf 'machine: a test\ndds:\n  reliable: %s\n  best_effort: %s\n  computed: %s\n' "$part" "$none" "$none" >"$1"
}
list flat.yaml 10us 1us 20us
list dear.yaml 100us 10us 200us
list full.yaml 0 0 3ms
cat >s.yaml <<YAML
duration: 2s
robots:
  talks:
    cpu: {costs: flat.yaml}
    clients: {writer: {command: [./node, write, "200", "2000", "2"]}}
  hears:
    cpu: {cores: 4, costs: flat.yaml}
    clients:
      one: {command: [./node, read, "200"]}
      two: {command: [./node, read, "200"]}
YAML
run() {  # FOLDER ARGUMENTS
  timeout 120 "$tcsim" run s.yaml --out "$@" >"$1.said" 2>&1 || fail "$(cat "$1.said")"
}
run flat --accounting fixed
run again --accounting fixed
run none --accounting fixed --set robots.talks.cpu.costs=none --set robots.hears.cpu.costs=none
run shipped --accounting fixed --set robots.talks.cpu.costs=null --set robots.hears.cpu.costs=null --set robots.hears.cpu.speed=0.5
run full --accounting fixed --set robots.hears.cpu.costs=full.yaml
run measured --set robots.talks.cpu.costs=dear.yaml --set robots.hears.cpu.costs=dear.yaml
for file in trace.json activations.csv dispatches.csv responses.csv hears-one.out.log; do cmp "flat/$file" "again/$file" || fail "$file differs"; done
python3 - <<'PY' || fail "$(cat ./*.said)"
import json
def summary(run): return json.load(open(f"{run}/summary.json"))
def late(run, who):
    times = [int(line.split()[1]) for line in open(f"{run}/hears-{who}.out.log") if line.startswith("late")]
    assert len(times) == 200, (run, who, len(times))
    return times
def median(times): return sorted(times)[len(times) // 2]
for run, times in (("flat", 1), ("measured", 10)):
    clients = summary(run)["clients"]
    assert clients["talks/writer"]["priced_ns"] == times * 200 * 11_000, (run, clients["talks/writer"]["priced_ns"])
    for who in ("one", "two"):
        assert clients[f"hears/{who}"]["priced_ns"] == times * 200 * 20_000, (run, who, clients[f"hears/{who}"]["priced_ns"])
# What programs take until they begin is on their clocks, too: a millisecond or two. Prices are 22 and 40.
for name, client in summary("measured")["clients"].items():
    computed, clock = client["charged_ns"] - client["priced_ns"], client["host_cpu_ns"]
    assert abs(computed - clock) <= 0.01 * clock + 6_000_000, (name, client)
assert all(client["priced_ns"] == 0 for client in summary("none")["clients"].values())
# The one that is sent to first hears of it 10 us later, and has it 20 us after that; the other one another microsecond later.
def cpu(run): return int(open(f"{run}/talks-writer.out.log").read().split()[1])
assert cpu("flat") == cpu("none") + 11_000, (cpu("flat"), cpu("none"))
first = sorted(median(late("flat", who)) - median(late("none", who)) for who in ("one", "two"))
assert 30_000 <= first[0] <= 31_000 and 30_000 <= first[1] <= 42_000, first
# Twice the price on half the speed, where it is the host's.
shipped = summary("shipped")
assert shipped["robots"]["talks"]["costs"]["list"] == "shipped with tcs", shipped["robots"]
assert summary("flat")["robots"]["talks"]["costs"]["list"].endswith("flat.yaml (a test)"), summary("flat")["robots"]
assert shipped["clients"]["talks/writer"]["priced_ns"] > 200 * 25_000, shipped["clients"]["talks/writer"]
assert shipped["clients"]["hears/one"]["priced_ns"] > 2 * 200 * 18_000, shipped["clients"]["hears/one"]
# 3 ms for each sample that comes after 2: the reader is a millisecond later with each, and each has a core for itself.
full = late("full", "one")
assert 190_000_000 < full[-1] < 215_000_000 and all(a < b for a, b in zip(full[2:], full[3:])), full[-5:]
assert summary("full")["clients"]["hears/one"]["priced_ns"] == 600_000_000
PY
exec_cpu() {  # COSTS
  timeout 120 "$tcsim" exec --accounting fixed --costs "$1" sh -c './node read 50 >/dev/null & ./node write 50 2000 1' | awk '/cpu/ { print $2 }'
}
(($(exec_cpu flat.yaml) == $(exec_cpu none) + 10000)) || fail "exec: $(exec_cpu flat.yaml) and $(exec_cpu none)"
! timeout 60 "$tcsim" exec --costs gone.yaml true 2>said || fail "a list that is not there"
grep -q '^tcsim: --costs: gone.yaml: cannot be read: .*; give the path of a list of prices, or write none$' said || fail "$(cat said)"
