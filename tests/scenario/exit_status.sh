#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# tcsim exec ends as its program ends.
# Topics: ends.
status=0; "$tcsim" exec -- sh -c 'exit 7' || status=$?
((status == 7)) || fail "exit 7 became $status"
status=0; "$tcsim" exec -- sh -c 'kill -TERM $$' || status=$?
((status == 143)) || fail "death by SIGTERM became $status"
status=0; "$tcsim" exec -- no-such-program-here 2>/dev/null || status=$?
((status == 127)) || fail "a missing program gave $status"
