#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A script that no shell with job control has begun, as in a container or by cron, and of which one process is stopped:
# the kernel sends such a group SIGHUP when the last process ends whose parent is in another group. A run is none.
# Topics: processes, signals.
script='sleep 1000 & stopped=$!
kill -STOP $stopped
is_stopped() { [[ $(ps -o state= $stopped) == T ]]; }
until is_stopped; do sleep 0.01; done  # which it is once it has had the processor
trap "echo hung up" HUP
"$@" >/dev/null
echo "status $?"
is_stopped && echo still stopped
kill -9 $stopped 2>/dev/null; true'
says() {  # WHAT IT SAYS COMMAND...
  local wanted=$1 said
  shift
  said=$(setsid --wait timeout 150 bash -c "$script" script "$@" 2>&1 | without_waits)
  [[ $said == "$wanted" ]] || fail "$*: $said"
}
# That the kernel does so.
hangs_up() { setsid --wait timeout 150 bash -c "$script" script "$@" 2>&1; }
hangs_up python3 -c '
import os, signal
signal.signal(signal.SIGHUP, signal.SIG_IGN)
group = os.getpgrp()
parent = os.fork()
if parent == 0:
    os.setpgid(0, 0)
    child = os.fork()
    if child == 0: os.setpgid(0, group)
    else: os.waitpid(child, 0)
    os._exit(0)
os.waitpid(parent, 0)' | grep -c '^hung up$' >/dev/null || fail 'the kernel hung up nobody'
for accounting in measured fixed; do
  says $'status 3\nstill stopped' "$tcsim" exec --accounting "$accounting" -- sh -c 'sleep 1; exit 3'
done
