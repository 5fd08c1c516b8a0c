#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Whoever is killed, and however: no process of the run is left, nor anything in /dev/shm. The client
# and its own child both spin at real-time priority.
# Topics: clean-up, priorities, containers.
mark="tcs_mark_$$"
program="sh -c 'while :; do :; done # $mark' & while :; do :; done # $mark"
trap 'pkill -9 -f "$mark" || true' EXIT

tcsim_pid() { echo "$tcsim_pid"; }
keeper_pid() { pgrep -P "$tcsim_pid"; }
coordinator_pid() { coordinator_of "$tcsim_pid"; }
# Not what hands over its descriptors in a container, which has its command line.
client_pid() { ps -o pid=,comm= --ppid "$(coordinator_pid)" | awk '$2 == "sh" {print $1}'; }

for victim in tcsim_pid:KILL keeper_pid:KILL coordinator_pid:KILL client_pid:KILL tcsim_pid:TERM tcsim_pid:HUP; do
  "$tcsim" exec -- sh -c "$program" 2>/dev/null &
  tcsim_pid=$!
  # The client's child executes its own command: what hands over descriptors has the client's for a moment, and its name.
  for _ in $(seq 1500); do
    pgrep -f "^sh -c while :; do :; done # $mark" >/dev/null && break
    sleep 0.1
  done
  kill "-${victim#*:}" "$(${victim%:*})"
  # Its killed parent does not end a child: that one is still a client, and ends with the run.
  if [[ $victim == client_pid:* ]]; then
    sleep 0.3
    kill -TERM "$tcsim_pid" || fail "the death of a client ended its child's run"
  fi
  left=""
  # Those that end them may have to wait for a processor, too.
  for _ in $(seq 500); do
    left=$(pgrep -af "$mark" | grep -v "^$$ " || true)
    [[ -z $left ]] && break
    sleep 0.1
  done
  [[ -z $left ]] || fail "after $victim there is still: $left"
done
[[ -z $(new_in_shm) ]] || fail "something is left in /dev/shm: $(new_in_shm)"
