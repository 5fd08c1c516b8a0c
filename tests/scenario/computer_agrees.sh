#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Ordinary programs find the cores of their robot, and its clocks, in whatever way each looks for them: one core, and
# more than this machine has.
# Topics: cores, ordinary programs, languages, clean-up.
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/threads.py" <<'PY'
import concurrent.futures, multiprocessing, os
print(os.cpu_count(), len(os.sched_getaffinity(0)), multiprocessing.cpu_count(),
      concurrent.futures.ThreadPoolExecutor()._max_workers - 4)
PY
count_of() {  # CORES MODE COMMAND WANTED
  local said
  said=$("$tcsim" exec --cores "$1" --accounting "$2" -- bash -c "$3" 2>"$folder/said") || fail "$3: $(cat "$folder/said")"
  [[ $said == "$4" ]] || fail "$2, $1 cores: '$3' says '$said' instead of '$4'"
}
more=$(($(getconf _NPROCESSORS_ONLN) + 3))
for mode in measured fixed; do
  for cores in 1 "$more"; do
    count_of "$cores" "$mode" nproc "$cores"
    count_of "$cores" "$mode" 'nproc --all' "$cores"
    count_of "$cores" "$mode" 'getconf _NPROCESSORS_ONLN' "$cores"
    count_of "$cores" "$mode" 'grep -c ^processor /proc/cpuinfo' "$cores"
    count_of "$cores" "$mode" 'grep -c ^cpu[0-9] /proc/stat' "$cores"
    count_of "$cores" "$mode" 'set -- /sys/devices/system/cpu/cpu[0-9]*; echo $#' "$cores"
    count_of "$cores" "$mode" 'perl -ne "\$n++ if /^processor/; END { print qq(\$n\n) }" /proc/cpuinfo' "$cores"
    count_of "$cores" "$mode" 'lscpu --parse=CPU,CORE,SOCKET,NODE | grep -v "^#" | sort -u | wc -l' "$cores"
    count_of "$cores" "$mode" 'lscpu --parse=SOCKET,NODE | grep -v "^#" | sort -u' '0,0'
    count_of "$cores" "$mode" "python3 $folder/threads.py" "$cores $cores $cores $((cores < 28 ? cores : 28))"
    ! command -v node >/dev/null ||
      count_of "$cores" "$mode" 'node -p "require(\"os\").cpus().length"' "$cores"
    ! command -v hwloc-calc >/dev/null ||
      count_of "$cores" "$mode" 'echo $(hwloc-calc --number-of core all) $(hwloc-calc --number-of pu all)' "$cores $cores"
  done
  count_of 4 "$mode" 'taskset -c 1,3 nproc' 2
  count_of 4 "$mode" 'taskset -c 1,3 grep Cpus_allowed_list /proc/self/status' $'Cpus_allowed_list:\t1,3'
done
# Since when: the robot has been on for thirty hours at the beginning, on the stroke of midnight.
in_time() {  # MODE COMMAND WANTED
  local said
  said=$(TZ=UTC "$tcsim" exec --uptime 30h --date 2005-03-18 --accounting "$1" -- bash -c "$2" 2>"$folder/said") ||
    fail "$2: $(cat "$folder/said")"
  [[ $said == "$3" ]] || fail "$1: '$2' says '$said' instead of '$3'"
}
for mode in measured fixed; do
  in_time "$mode" 'uptime -p; uptime -s' $'up 1 day, 6 hours, 0 minutes\n2005-03-16 18:00:00'
  in_time "$mode" 'sleep 3700; uptime -p' 'up 1 day, 7 hours, 1 minute'
  # `ps` of what has slept for an hour, and began then.
  in_time "$mode" 'sleep 5000 & sleep 3600; ps -o etime=,time=,lstart= -p $! | tr -s " "; kill $!' \
    ' 01:00:00 00:00:00 Fri Mar 18 00:00:00 2005'
  # What has computed two seconds of three.
  in_time "$mode" "python3 -c 'import time
while time.process_time() < 2: pass
time.sleep(1)
print(round(sum(map(int, open(\"/proc/self/stat\").read().split()[13:15])) / 100))'" 2
  in_time "$mode" 'top -b -n2 -d 60 | grep ^top | cut -c1-14' $'top - 00:00:00\ntop - 00:01:00'
done
# Of the folders that some of these have listed none is left, also where the run is killed.
"$tcsim" exec -- bash -c 'ls /sys/devices/system/cpu >/dev/null; sleep 0.1; touch "$0"; while :; do :; done' "$folder/listed" \
  >/dev/null 2>&1 &  # nor may it keep this test's stdout open, should it go on
run=$!
trap '[[ -z $run ]] || kill -9 "$run" 2>/dev/null || true; rm -rf "$folder"' EXIT
processes() { ps -eLo pid,ppid,tid,stat,psr,cls,rtprio,etime,time,wchan:24,args | grep -E 'tcsim|bash -c ls'; }
# It may have to wait for a processor first.
within 200 test -e "$folder/listed" ||
  fail "the run did not begin: $(processes; timeout 20 "$tcsim" dump "$(coordinator_of "$run")" 2>&1)"
coordinator=$(coordinator_of "$run")
kill -9 "$coordinator"
has_ended() { ! kill -0 "$run" 2>/dev/null; }
within 60 has_ended || fail "the run goes on without its coordinator, $coordinator: $(processes)"
wait "$run" 2>/dev/null || true
run=  # its number may be another process's from now on
left=$(new_in_shm | grep tcs-computer) || true
[[ -z $left ]] || fail "left behind: $left"
