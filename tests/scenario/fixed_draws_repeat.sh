#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Random numbers are the same in each run under fixed accounting, and others under measured.
# Topics: determinism.
draws() { "$tcsim" exec --accounting "$1" -- "$build/bin/conformance_randomness" "$1"; }
first=$(draws fixed)
(($(wc -l <<<"$first") > 50)) || fail "more than fifty draws were expected, not: $first"
second=$(draws fixed)
[[ $first == "$second" ]] || fail "two runs drew differently: $(diff <(echo "$first") <(echo "$second"))"
same=$(comm -12 <(sort <<<"$first") <(draws measured | sort))
[[ -z $same ]] || fail "measured accounting drew the same numbers: $same"
# Programs that read the kernel's device by themselves, as much as they want.
reads() {
  "$tcsim" exec --accounting "$1" -- \
    sh -c 'head -c 3000000 /dev/urandom | md5sum; od -An -N8 /dev/random; od -An -N8 </dev/urandom
      cat /proc/sys/kernel/random/uuid; python3 -c "print(open(\"/dev/urandom\", \"rb\").read(8))"'
}
first=$(reads fixed)
[[ $first == "$(reads fixed)" ]] || fail "what two runs read differs: $first"
[[ $first != "$(reads measured)" ]] || fail "measured accounting read the same"
