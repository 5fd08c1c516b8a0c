#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Jobs, traps and timeouts of bash, and what people write in pipelines. Allocations cost nothing,
# so that a shell does what it does next before its child has begun. Where seconds are counted, they
# are those of the calendar: each begins with a new one, for computing takes some milliseconds.
# Topics: languages, signals, processes, timers.
begin='sleep 0.$(printf %09d $((1000000000 - 1$(date +%N) + 1000000000)))'
expect() {
  local wanted=$1 said accounting
  for accounting in ${only:-measured fixed}; do
    said=$("$tcsim" exec --accounting "$accounting" --allocation-cost 0 -- \
      bash -c "$begin; exec bash -c \"\$1\"" bash "$2" 2>&1 | without_waits)
    [[ $said == "$wanted" ]] || fail "$accounting: '$2' says '$said' instead of '$wanted'"
  done
}
expect 'at 6' 'seq 8 | xargs -P4 -I{} sleep 3; echo at $SECONDS'
expect '124 at 5' 'timeout 5 sleep 100; echo $? at $SECONDS'
expect '143 at 2' 'sleep 100 & sleep 2; kill $!; wait $! 2>/dev/null; echo $? at $SECONDS'
expect 'at 3, then 5' 'exec 2>/dev/null; set -m; sleep 5 & sleep 3 & wait -n; printf "at $SECONDS, "
  wait; echo then $SECONDS'
expect 'Running' 'set -m; sleep 5 & jobs | grep -o Running; wait 2>/dev/null'
expect 'trapped at 2, 138' 'trap "printf \"trapped at \$SECONDS, \"" USR1; (sleep 2; kill -USR1 $$) &
  sleep 10 & wait $!; echo $?'
expect '142 at 3' 'read -t 3 line < <(sleep 100); echo $? at $SECONDS'
expect '3' 'TIMEFORMAT=%0R; time sleep 3'
expect 'alarm after 7' "perl -e '\$start = time; sleep 2; select(undef, undef, undef, 2);
  \$SIG{ALRM} = sub { die qq(alarm) }; eval { alarm 3; sleep 100 }; \$@ =~ /alarm/ and
  printf qq(alarm after %d), time - \$start'"
# Stopped while it waits, and before it has begun: where computing takes time, on a slow host bash's
# turn is over before it sends the signal.
expect '0 at 6' 'sleep 3 & sleep 1; kill -STOP $!; sleep 5; kill -CONT $!; wait $!; echo $? at $SECONDS'
only=fixed expect '0 at 4' 'sleep 3 & kill -STOP $!; sleep 1; kill -CONT $!; wait $!; echo $? at $SECONDS'
