#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Random numbers are the same in each run under fixed accounting, and others under measured.
# Topics: determinism.
draws() { "$tcsim" exec --accounting "$1" -- "$build/bin/conformance_randomness" "$1"; }
first=$(draws fixed)
[[ $(wc -w <<<"$first") == 9 ]] || fail "nine draws were expected, not: $first"
second=$(draws fixed)
[[ $first == "$second" ]] || fail "two runs drew differently: $first and $second"
measured=$(draws measured)
[[ $first != "$measured" ]] || fail "measured accounting drew the same numbers"
# Programs that read the kernel's device by themselves, as much as they want.
reads() {
  "$tcsim" exec --accounting "$1" -- \
    sh -c 'head -c 3000000 /dev/urandom | md5sum; od -An -N8 /dev/random; python3 -c "print(open(\"/dev/urandom\", \"rb\").read(8))"'
}
first=$(reads fixed)
[[ $first == "$(reads fixed)" ]] || fail "what two runs read differs: $first"
[[ $first != "$(reads measured)" ]] || fail "measured accounting read the same"
