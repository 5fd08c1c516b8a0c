# Shared by the scenario tests: the command under test, and how a test says that something is wrong.
set -euo pipefail
build=$1
source_root=$2
tcsim=$build/bin/tcsim
if [[ ${3:-} == in_container ]]; then
  export TCS_BUILD=$build
  tcsim=$source_root/tests/scenario/contained_tcsim.sh
fi
# The process that coordinates the run whose tcsim has this number: tcsim > its keeper > it.
coordinator_of() { pgrep -P "$(pgrep -P "$1")"; }
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
# What is left in /dev/shm by now and was not there when the test began. Others' files come and go: what is left is
# still there a second later.
shared_at_start=$(ls /dev/shm)
new_in_shm() {
  local now
  now=$(comm -13 <(sort <<<"$shared_at_start") <(ls /dev/shm | sort))
  [[ -n $now ]] || return 0
  sleep 1
  comm -12 <(printf "%s\n" "$now") <(ls /dev/shm | sort)
}
# The file of the first library of the loader's that matches; nothing where there is none. The whole list is read: who
# stops reading ends `ldconfig` by SIGPIPE, and with it, under pipefail, the test.
library() { ldconfig -p | awk -v pattern="$1" '$0 ~ pattern && !found { found = 1; print $NF }'; }
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
run_on_one_and_two() {  # SCENARIO FOLDER
  local cpus
  (($(nproc) > 1)) || { echo "this machine has one processor"; exit 77; }
  for cpus in 1 2; do
    "$tcsim" run "$1" --host-cpus "$cpus" --out "$2/$cpus" >"$2/said" 2>&1 || fail "$(cat "$2/said")"
  done
}
# Kills the coordinator of a run in the background once its bag has more messages than that.
kill_once_recorded() {  # TCSIM_PID BAG MESSAGES
  local _
  # It may have to wait for a processor first.
  for _ in $(seq 600); do
    [[ -e $2/metadata.yaml && $(sed -n 's/^  message_count: //p' "$2/metadata.yaml") -gt $3 ]] && break
    sleep 0.1
  done
  kill -9 "$(coordinator_of "$1")"
  wait "$1" 2>/dev/null || true
}
