#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Both preloaded libraries export what their maps list, no more and no less, and depend on libc
# alone.
check() {
  local library=$build/lib/$1 map=$source_root/libtcs_preload/$2 listed has needed
  listed=$(sed -n 's/^ *\([A-Za-z_0-9]*\);$/\1/p' "$map" | LC_ALL=C sort)
  has=$(nm -D --defined-only "$library" | awk '{print $3}' | LC_ALL=C sort)
  diff <(echo "$listed") <(echo "$has") || fail "the exported symbols of $1 are not those of its map"
  needed=$(readelf -d "$library" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p')
  [[ $needed == libc.so.6 ]] || fail "$1 depends on: $needed"
}
check libtcs_preload.so exports.map
check libtcs_allocations.so allocations/exports.map
