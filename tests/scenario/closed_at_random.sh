#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Descriptors are closed, replaced and used again at random while other threads wait at them: each reader finds what was
# written to its file, or its end, as it does natively; on one core and on four, with rights and without. A third argument
# is how many are closed, copied and read, instead of 8000.
# Topics: descriptors, threads, rights, determinism.
operations=${3:-8000}
program=$build/bin/closing_at_random
with_rights() {  # ACCOUNTING CORES SEED
  timeout 900 "$tcsim" exec --accounting "$1" --cores "$2" -- "$program" "$operations" "$3" tcs ||
    fail "$1, $2 cores, seed $3: status $?"
}
without_rights() {  # ACCOUNTING CORES OPERATIONS OPTION...
  timeout 900 "$source_root/tests/conformance/without_rights.sh" "${@:4}" "$build" exec --accounting "$1" --cores "$2" -- \
    "$program" "$3" 3 tcs 2>said || fail "$* without rights: $(cat said)"
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
timeout 900 "$program" "$operations" 1 || fail "natively: status $?"
for cores in 1 4; do
  with_rights measured $cores 2
  first=$(with_rights fixed $cores 3)
  second=$(with_rights fixed $cores 3)
  [[ $first == "$second" ]] || fail "two fixed runs on $cores cores differ: $first and $second"
  echo "$first"
done
if ((operations <= 8000)); then
  without_rights measured 1 $((operations / 4))
  without_rights measured 1 $((operations / 4)) --in-container
  without_rights fixed 4 $((operations / 4)) --in-container
else
  for cores in 1 4; do
    for accounting in measured fixed; do
      without_rights $accounting $cores "$operations"
      without_rights $accounting $cores "$operations" --in-container
    done
  done
fi
