#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The tutorial's controller on DDS takes each sample of its robot's odometry in time. One that computes for 15 ms on each of
# 100 Hz does not, and the run says so: by which it was released, how old its commands are, and how many samples its reader
# has let go. All of a late activation's time is accounted for, to the nanosecond.
# Topics: verdict, dds.
type idlc gcc >/dev/null 2>&1 || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$source_root"/examples/hover/hover_dds.* "$work"
cd "$work"
idl=$source_root/coordinator/dds/idl
for messages in builtin_interfaces std_msgs geometry_msgs nav_msgs; do idlc -x final -I "$idl" "$idl/$messages.idl"; done
{
  echo '#include <time.h>
static void burn(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  const double until = now.tv_sec + now.tv_nsec * 1e-9 + 0.015;
  do clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  while (now.tv_sec + now.tv_nsec * 1e-9 < until);
}'
  sed 's/while (dds_take.*{$/& burn();/' hover_dds.c
} >slow_dds.c
cmp -s <(grep -c 'burn();' slow_dds.c) <(echo 1) || fail "the controller of the tutorial takes its samples otherwise"
for program in hover slow; do
  gcc "${program}_dds.c" builtin_interfaces.c std_msgs.c geometry_msgs.c nav_msgs.c -lddsc -o "${program}_dds" &
done
wait
sed 's/hover_dds/slow_dds/' hover_dds.yaml >slow_dds.yaml
for program in hover slow; do
  timeout 200 "$tcsim" run "${program}_dds.yaml" --set 'expect={}' --accounting fixed --out $program >said 2>&1 || fail "$(cat said)"
  mv said $program.said
done
! grep '^! ' hover.said || fail "it kept up"
for words in 'drone/controller missed \(all \)\?33[0-9] of its deadlines (10 ms, the period of odometry)' \
  'it computes 15 ms each time, 150 % of a core' 'drone/controller sent commands made of samples up to 2[0-5]\.\?[0-9]* ms old'; do
  grep -q "^! .*$words" slow.said || fail "nobody said '$words': $(cat slow.said)"
done
python3 - <<'PY' || fail "$(cat slow.said)"
import json
def controller(run): return json.load(open(run + "/summary.json"))["clients"]["drone/controller"]
well, slow = controller("hover"), controller("slow")
assert well["deadline"]["missed"] == 0 and well["deadline"]["judged"] >= 498, well
[odometry] = well["inputs"]
assert odometry["received"] == odometry["sent"] >= 498 and odometry["replaced"] == 0 and odometry["age_ns"]["max"] < 100_000, odometry
# Its history keeps one: of three samples it gets two.
[odometry] = slow["inputs"]
assert odometry["from"] == "odometry" and odometry["sent"] >= 498, odometry
assert abs(odometry["replaced"] / odometry["sent"] - 1 / 3) < 0.01, odometry
assert odometry["sent"] - odometry["received"] - odometry["replaced"] in (0, 1), odometry
late = slow["late"]
assert late["total_ns"] == late["queued_ns"] + late["executed_ns"] + sum(late["others_ns"].values()), late
PY
