#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A program that reads the kernel's clock past the C library sees virtual time, unless told
# otherwise.
# Topics: preloading, timers.
said=$(timeout 150 "$tcsim" exec --no-patch-vdso -- "$build/bin/vdso_reader")
[[ $said == none ]] && exit 0
# That is real time, in which a second may pass, and in which the host may stand for some.
[[ $said =~ ^[0-5]?[0-9]$ ]] || fail "unpatched, an hour's sleep took $said s by the host's clock"
for accounting in measured fixed; do
  said=$(timeout 150 "$tcsim" exec --accounting "$accounting" -- sh -c "$build/bin/vdso_reader")
  [[ $said == 3600 ]] || fail "patched, an hour's sleep took $said s"
done
