#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A program that reads the kernel's clock past the C library sees virtual time, unless told
# otherwise.
# Topics: preloading, timers.
said=$(timeout 20 "$tcsim" exec --no-patch-vdso -- "$build/bin/vdso_reader")
[[ $said == none ]] && exit 0
[[ $said == 0 ]] || fail "unpatched, an hour's sleep took $said s by the host's clock"
for accounting in measured fixed; do
  said=$(timeout 20 "$tcsim" exec --accounting "$accounting" -- sh -c "$build/bin/vdso_reader")
  [[ $said == 3600 ]] || fail "patched, an hour's sleep took $said s"
done
