#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Descriptors are closed, replaced and used again at random while other threads wait at them: each reader finds what was
# written to its file, or its end, as it does natively. A third argument is how many are closed, copied and read, instead
# of 8000.
# Topics: descriptors, threads, rights.
operations=${3:-8000}
program=$build/bin/closing_at_random
in_mode() {  # ACCOUNTING SEED
  timeout 900 "$tcsim" exec --accounting "$1" -- "$program" "$operations" "$2" tcs
}
without_rights() {  # ACCOUNTING OPTION...
  timeout 900 "$source_root/tests/conformance/without_rights.sh" "${@:2}" "$build" exec --accounting "$1" -- \
    "$program" "$((operations / 4))" 3 tcs 2>said || fail "$* without rights: $(cat said)"
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
timeout 900 "$program" "$operations" 1 || fail "natively"
in_mode measured 2 || fail "measured"
first=$(in_mode fixed 3) || fail "fixed: $first"
echo "$first"
second=$(in_mode fixed 3) || fail "fixed, again: $second"
[[ $first == "$second" ]] || fail "two fixed runs differ: $first and $second"
without_rights measured
without_rights measured --in-container
without_rights fixed --in-container
