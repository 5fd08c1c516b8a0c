#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The shim exports what its map lists, no more and no less, and depends on libc alone.
map=$(sed -n 's/^ *\([A-Za-z_0-9]*\);$/\1/p' "$source_root/libtcs_preload/exports.map" | LC_ALL=C sort)
has=$(nm -D --defined-only "$build/lib/libtcs_preload.so" | awk '{print $3}' | LC_ALL=C sort)
diff <(echo "$map") <(echo "$has") || fail "the exported symbols are not those of the map"
needed=$(readelf -d "$build/lib/libtcs_preload.so" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p')
[[ $needed == libc.so.6 ]] || fail "the shim depends on: $needed"
