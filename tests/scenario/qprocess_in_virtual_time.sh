#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/as_nobody.sh"
# Qt's QProcess starts programs by the system call: Qt 5 by a clone, Qt 6 by one that has its parent's memory, on a
# stack of 4 KiB. They are there from their births on, and their ends are seen when they end.
# Topics: processes, ordinary programs, determinism, rights.
rounds=${3:-2}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"
cd "$work"
install_for_everybody "$build" "$work"
expect() {  # WHOSE SAID
  local line what ns=() slack=60000000
  line=$(sed 's/, [0-9]* ns$//' <<<"$2")
  what=$'1 1 0 hi\n1 1 0 later\n1 1 0 what was written\nmissing: 0'
  [[ $line == "$what" ]] || fail "$1: $2"
  mapfile -t ns < <(sed -n 's/.*, \([0-9]*\) ns$/\1/p' <<<"$2")
  ((ns[0] < slack && ns[1] >= 2000000000 && ns[1] < 2000000000 + slack && ns[2] >= 1000000000 && ns[2] < 1000000000 + slack)) ||
    fail "$1: $2"
}
found=0
for qt in 5 6; do
  flags=$(pkg-config --cflags --libs Qt${qt}Core 2>/dev/null) || continue
  g++ -O1 -fPIC -o qt$qt "$source_root/tests/scenario/runtimes/starts.cc" $flags || fail "Qt $qt"
  chmod 755 qt$qt
  found=1 first=
  expect "Qt $qt, measured" "$(timeout 60 "$tcsim" exec -- ./qt$qt)"
  for accounting in measured fixed; do
    expect "Qt $qt, $accounting, without rights" \
      "$(timeout 60 "${nobody[@]}" "$work/bin/tcsim" exec --accounting $accounting -- ./qt$qt 2>stderr)"
  done
  for ((round = 0; round < rounds; ++round)); do
    said=$(timeout 60 "$tcsim" exec --accounting fixed -- ./qt$qt) || fail "Qt $qt, fixed: $said"
    expect "Qt $qt, fixed" "$said"
    [[ $said == "${first:=$said}" ]] || fail "Qt $qt: $said, and before: $first"
  done
done
((found)) || { echo "neither qtbase5-dev nor qt6-base-dev is there"; exit 77; }
