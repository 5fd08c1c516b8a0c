# Sourced by tests that run programs natively, as the reference for what they do under tcs.
#
# steadily BUILD COMMAND...: the time of COMMAND is real time, which a loaded machine bends. Where it fails and the machine has
# kept a thread waiting for longer than 1 ms meanwhile, the failure says nothing of COMMAND, which is run again, five times
# in all. A failure on a machine that did not stall stands. Others may have the processors for seconds: the next time is
# further and further away, so that not all five are in one such while. Each time COMMAND is a process group, which is
# ended with it: a child that outlived a failed time would signal whoever has its parent's number by then.
steadily() {
  local build=$1 status ready stall later tried
  shift
  for later in 0 1 3 9 20; do
    sleep "$later"
    coproc stall_watch { exec "$build/bin/stall_watch"; }
    local watch=$stall_watch_PID from=${stall_watch[0]}
    read -r ready <&"$from"
    status=0
    set -m
    "$@" <&0 &
    tried=$!
    set +m
    wait "$tried" || status=$?
    kill -KILL -- "-$tried" 2>/dev/null || true
    kill "$watch"
    read -r stall <&"$from"
    wait "$watch"
    ((status != 0)) || return 0
    echo "ended with $status; the machine kept threads waiting for $stall us at most" >&2
    ((stall > 1000)) || return "$status"
  done
  return "$status"
}
