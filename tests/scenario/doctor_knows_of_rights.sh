#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/as_nobody.sh"
# `tcsim doctor` and each run name what keeps tcsim from real-time priorities, and the command that mends it: the missing
# capability and limit of a user, and of root; a limit that is too low; a user namespace; a real-time group without a
# budget; a seccomp filter. Where the command can be called here, it helps.
# Topics: doctor, rights, priorities.
((EUID == 0)) || exit 77  # to take away what there is
command -v python3 >/dev/null || exit 77
out=$(mktemp -d)
group=
trap '[[ -z $group ]] || rmdir "$group"; rm -rf "$out"' EXIT
chmod 755 "$out"
install_for_everybody "$build" "$out" without_real_time
cd "$out"

doctor() {  # COMMAND...: of the real-time priority: verdict, what was found, how to mend it
  "$@" "$out/bin/tcsim" doctor --json | python3 -c '
import json, sys
(f,) = [f for f in json.load(sys.stdin) if f["name"] == "real-time priority"]
print(f["verdict"], f["found"], f["mend"], sep="\n")'
}
works() {  # COMMAND...
  local finding
  finding=$(doctor "$@")
  [[ $finding == ok$'\n'* ]] || fail "$*: the doctor says $finding"
  "$@" timeout 200 "$out/bin/tcsim" exec -- true >"$out/said" 2>&1 || fail "$*: $(cat "$out/said")"
  ! grep -q 'SCHED_FIFO is not permitted' "$out/said" || fail "$*: the doctor sees nothing, but $(cat "$out/said")"
}
lacks() {  # REASON MEND COMMAND...
  local reason=$1 mend=$2 finding
  shift 2
  finding=$(doctor "$@")
  [[ $finding == warning$'\n'*"($reason)"*$'\n'*"$mend"* ]] || fail "$*: the doctor says $finding"
  "$@" timeout 200 "$out/bin/tcsim" exec -- true >"$out/said" 2>&1 || fail "$*: $(cat "$out/said")"
  grep -qF "SCHED_FIFO is not permitted here, so gates keep the threads apart and the run takes longer: $reason; " \
    "$out/said" && grep -qF -- "$mend" "$out/said" || fail "$*: the run says $(cat "$out/said")"
}
[[ $(doctor env) == ok$'\n'* ]] || { echo "SKIPPED: $(doctor env)"; exit 77; }

works env
neither='CAP_SYS_NICE is missing and RLIMIT_RTPRIO is 0'
user=(prlimit --rtprio=0:0 setpriv --reuid=65534 --regid=65534 --clear-groups)
lacks "$neither" 'run tcsim as root, or call `sudo prlimit --rtprio=14 --pid $$`' "${user[@]}"
lacks "$neither" '--ulimit rtprio=14 for everybody' "${nobody[@]}"
# Root is not told to run as root.
lacks "$neither" 'start it with CAP_SYS_NICE or with RLIMIT_RTPRIO at 14' \
  prlimit --rtprio=0:0 setpriv --bounding-set=-sys_nice,-sys_resource --inh-caps=-sys_nice,-sys_resource
mended() { sh -c "$1"' && exec "$@"' sh "${@:2}"; }  # SHELL'S WORDS, which go before COMMAND...
if prlimit --rtprio=5:20 true 2>/dev/null; then
  user[1]=--rtprio=5:20
  lacks 'CAP_SYS_NICE is missing and RLIMIT_RTPRIO is 5, below 14' 'call `ulimit -r 14`' "${user[@]}"
  works "${user[@]}" bash -c 'ulimit -r 14; exec "$@"' bash
  # Root without CAP_SYS_NICE may raise its own.
  user=(prlimit --rtprio=0:0 setpriv --bounding-set=-sys_nice --inh-caps=-sys_nice)
  lacks "$neither" 'call `ulimit -r 14`' "${user[@]}"
  works "${user[@]}" bash -c 'ulimit -r 14; exec "$@"' bash
fi
! unshare --user --map-root-user true 2>/dev/null ||
  lacks 'CAP_SYS_NICE does not count in a user namespace and RLIMIT_RTPRIO is 0' 'outside of the user namespace' \
    prlimit --rtprio=0:0 unshare --user --map-root-user
lacks 'a seccomp filter refuses it' 'start tcsim outside of it, or let it permit sched_setscheduler' "$out/bin/without_real_time"

# On kernels with real-time groups a new group has no budget. The one above has.
top=/sys/fs/cgroup/cpu
if [[ -w $top/cpu.rt_runtime_us ]] && (($(cat /proc/sys/kernel/sched_rt_runtime_us) >= 0)) && mkdir $top/tcs_test_$$; then
  group=$top/tcs_test_$$
  reason="its real-time group has no budget: $group/cpu.rt_runtime_us is 0"
  mend="echo \$\$ >$top/tasks"
  lacks "$reason" "call \`$mend\`" mended "echo \$\$ >$group/tasks"
  works mended "echo \$\$ >$group/tasks && $mend"
  lacks "$neither; $reason" 'let root call `sysctl -w kernel.sched_rt_runtime_us=-1`' \
    mended "echo \$\$ >$group/tasks" prlimit --rtprio=0:0 setpriv --reuid=65534 --regid=65534 --clear-groups
  # A robot's programs have what the user has, not the group: see conformance.scheduling_rights.
  for accounting in measured fixed; do
    mended "echo \$\$ >$group/tasks" timeout 200 "$tcsim" exec --accounting $accounting -- \
      "$build/bin/conformance_scheduling_rights" $accounting >"$out/said" 2>&1 || fail "$accounting: $(cat "$out/said")"
  done
fi
[[ -z $(new_in_shm) ]] || fail "left in /dev/shm: $(new_in_shm)"
