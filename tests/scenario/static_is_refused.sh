#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A static program is refused before it starts, in one sentence.
# Topics: preloading, failures.
status=0
said=$("$tcsim" exec -- "$build/bin/tcs_static_program" 2>&1) || status=$?
((status == 2)) || fail "a static program gave status $status"
[[ $said == *static* && $said == tcsim:* ]] || fail "unclear: $said"
