# Shared by the scenario tests: the command under test, and how a test says that something is wrong.
set -euo pipefail
build=$1
source_root=$2
tcsim=$build/bin/tcsim
# Debian's Python goes first: it has the packages, and another one may be a script that starts three programs (pyenv), a
# thousand times a test.
PATH=/usr/bin:$PATH
# Where no locale is set Python would set one for what it starts, which then costs more than what a script starts.
export PYTHONCOERCECLOCALE=0
if [[ ${3:-} == in_container ]]; then
  export TCS_BUILD=$build
  tcsim=$source_root/tests/scenario/contained_tcsim.sh
fi
# The process that coordinates the run whose tcsim has this number: tcsim > its keeper > it.
coordinator_of() { pgrep -P "$(pgrep -P "$1")"; }
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
# What is left in /dev/shm by now and was not there when the test began. Others' files come and go with their runs: what
# is left stays.
shared_at_start=$(ls /dev/shm)
new_in_shm() {
  local now i
  now=$(comm -13 <(sort <<<"$shared_at_start") <(ls /dev/shm | sort))
  for ((i = 0; i < 500; ++i)); do  # longer than a run of another test's goes on
    [[ -n $now ]] || return 0
    sleep 0.2
    now=$(comm -12 <(printf "%s\n" "$now") <(ls /dev/shm | sort))
  done
  printf "%s\n" "$now"
}
# Whether the command comes to succeed within so many seconds. They are real ones: where runs have all processors, a look
# every tenth of a second is one a second.
within() {  # SECONDS COMMAND...
  local until=$((SECONDS + $1))
  until "${@:2}"; do
    ((SECONDS < until)) || return 1
    sleep 0.1
  done
}
# Whether no process with these words in its command line is left, once those that were killed have had a processor to end.
none_left() {  # WORDS
  local i
  for ((i = 0; i < 100; ++i)); do
    pgrep -f "$1" >/dev/null || return 0
    sleep 0.2
  done
  return 1
}
# The file of the first library of the loader's that matches; nothing where there is none. The whole list is read: who
# stops reading ends `ldconfig` by SIGPIPE, and with it, under pipefail, the test.
library() { ldconfig -p | awk -v pattern="$1" '$0 ~ pattern && !found { found = 1; print $NF }'; }
# What a run says, without that it waits for a processor, which it may have to beside other tests.
without_waits() { sed '/^tcsim: other runs of tcsim have/d'; }
# Becomes a command, at a real-time priority where that may be: in the background or a pipe only. For what is outside of runs,
# which have the processors, and is to be as quick as on another computer.
on_time() {
  if chrt -f 50 true 2>/dev/null; then exec chrt -f 50 "$@"; fi
  exec "$@"
}
# The same for this shell and what it starts, until `be_ordinary`: for what has to be done while a short run goes on.
be_on_time() { chrt -f -p 50 $$ >/dev/null 2>&1 || true; }
be_ordinary() { chrt -o -p 0 $$ >/dev/null 2>&1 || true; }
# Starts a function beside what goes on already. `all_done` waits for all of these, and ends the test if one has failed.
started=()
beside() { "$@" & started+=("$!"); }
all_done() {
  local pid failed=0
  for pid in "${started[@]}"; do wait "$pid" || failed=1; done
  started=()
  ((failed == 0)) || exit 1
}
# Runs a scenario on one processor of the host, and again on two, where threads compute ahead: into the folders 1 and
# 2 of the one that is given.
# With one processor of the host's and with two. FIGURE of the summary says that the second one was used. A second one
# that others have all the time nobody can use: then the test is left out.
run_on_one_and_two() {  # SCENARIO FOLDER FIGURE
  local cpus before began left took
  (($(nproc) > 1)) || { echo "this machine has one processor"; exit 77; }
  for cpus in 1 2; do
    before=$(idle_centiseconds) began=$(date +%s%N)
    "$tcsim" run "$1" --host-cpus "$cpus" --out "$2/$cpus" >"$2/said" 2>&1 || fail "$(cat "$2/said")"
    left=$((10 * ($(idle_centiseconds) - before))) took=$((($(date +%s%N) - began) / 1000000))
  done
  ! grep -q "\"$3\": 0[,}]*$" "$2/2/summary.json" && return
  ((5 * left <= took)) && { echo "others have this machine's second processor all the time"; exit 77; }
  fail "$3 is 0, though processors were idle for $left of $took ms: $(cat "$2/said")"
}
idle_centiseconds() { awk '/^cpu / { print $5 + $6 }' /proc/stat; }
# Kills the coordinator of a run in the background once its bag has more messages than that.
kill_once_recorded() {  # TCSIM_PID BAG MESSAGES
  local _
  # It may have to wait for a processor first.
  for _ in $(seq 2000); do
    [[ -e $2/metadata.yaml && $(sed -n 's/^  message_count: //p' "$2/metadata.yaml") -gt $3 ]] && break
    sleep 0.1
  done
  kill -9 "$(coordinator_of "$1")"
  wait "$1" 2>/dev/null || true
}
