#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The libraries that programs get export what their maps list, no more and no less, and depend on
# libc alone, but for the one that is for programs that use Cyclone DDS.
# Topics: packages, preloading.
check() {
  local library=$build/lib/$1 map=$source_root/libtcs_preload/$2 allowed=$3 listed has needed
  listed=$(sed -n 's/^ *\([A-Za-z_0-9]*\);$/\1/p' "$map" | LC_ALL=C sort)
  has=$(nm -D --defined-only "$library" | awk '{print $3}' | LC_ALL=C sort)
  diff <(echo "$listed") <(echo "$has") || fail "the exported symbols of $1 are not those of its map"
  needed=$(readelf -d "$library" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | grep -Ev "^($allowed)$" || true)
  [[ -z $needed ]] || fail "$1 depends on: $needed"
}
check libtcs_preload.so exports.map 'libc\.so\.6'
check libtcs_allocations.so allocations/exports.map 'libc\.so\.6'
check libtcs_dds.so dds/exports.map '(libc|libstdc\+\+|libgcc_s|libddsc|ld-linux-x86-64)\.so\..*'
# It calls nothing of its own by a name that another library could stand before: one that hands calls on would get them
# again.
for library in preload allocations; do
  by_name=$(comm -12 <(readelf -rW "$build/lib/libtcs_$library.so" | awk '/JUMP_SLO|GLOB_DAT/ { sub("@.*", "", $5); print $5 }' |
    LC_ALL=C sort -u) <(nm -D --defined-only "$build/lib/libtcs_$library.so" | awk '{ print $3 }' | LC_ALL=C sort))
  [[ -z $by_name ]] || fail "libtcs_$library.so calls itself by name: $by_name"
done
# The shim is in programs without libddsc: it has names of it, but refers to none.
refers=$(nm -D --undefined-only "$build/lib/libtcs_preload.so" | grep -E ' (dds|ddsi|ddsrt|rtps)_' || true)
[[ -z $refers ]] || fail "the shim refers to symbols of libddsc: $refers"
# What the shim stands before must be there in Debian's libddsc.
missing=$(comm -23 <(sed -n 's/^ *X(\([a-z0-9_]*\)).*/\1/p' "$source_root/libtcs_preload/dds/calls.h" | LC_ALL=C sort) \
  <(nm -D --defined-only "$(library libddsc.so.0debian)" | awk '{print $3}' | LC_ALL=C sort))
[[ -z $missing ]] || fail "libddsc does not have: $missing"
