#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The archive of `./dev package` brings what distributions lack, wherever it is installed, and asks of the C and the C++
# library no more than Ubuntu 22.04 has. `./dev test --packages` tries it on other distributions.
# Topics: packages.
type patchelf >/dev/null 2>&1 || exit 77
grep -q bookworm /etc/os-release || exit 77  # on newer ones it asks for newer libraries
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$source_root/cmake/archive.sh" "$build" "$work/archive" || fail "the archive is not made"
"$work/archive/install.sh" "$work/tcs" >"$work/said" || fail "it does not install: $(cat "$work/said")"
! "$work/archive/install.sh" "$work/tcs" 2>"$work/said" || fail "it installs over another one"
rm -rf "$work/archive"

mapfile -t files < <(find "$work/tcs/bin" "$work/tcs/lib" -type f \( -perm -u+x -o -name '*.so*' \))
((${#files[@]} > 30)) || fail "there are ${#files[@]} files"
for file in "${files[@]}"; do readelf --version-info --wide "$file" 2>/dev/null; done |
  grep -oE '\b(GLIBC|GLIBCXX|CXXABI|GCC)_[0-9.]+' | sort -Vu | awk -F_ '{ newest[$1] = $0 } END { for (i in newest) print newest[i] }' |
  sort >"$work/newest"
diff - "$work/newest" <<'END' || fail "it asks for other versions of the distribution's libraries"
CXXABI_1.3.13
GCC_4.3.0
GLIBCXX_3.4.30
GLIBC_2.35
END
readelf --dynamic "$work"/tcs/lib/*/tcs/libtcs_preload.so | grep NEEDED | grep -v 'libc\.so\.6\|ld-linux' && fail "the shim needs these"

for file in "$work/tcs/bin/tcsim" $(find "$work/tcs/lib" -type f \( -name 'tcsim-*' -o -name tcs-dds-gateway \)); do
  env -i ldd "$file" | awk '$2 == "=>" { print $3 }' | xargs realpath -s | grep -v "^$work/tcs/lib/carried/" |
    grep -vE '/(libc|libm|libstdc\+\+|libgcc_s|libpthread)\.so[.0-9]*$' && fail "$file takes these from elsewhere"
done
for package in zlib1g libsimbody3.7 libddsc0debian; do
  [[ -s $work/tcs/share/doc/tcsim/carried/$package ]] || fail "the licence of $package is missing"
done
# In nanoseconds: the programs compute between the readings, by which one of seconds may be in the next one.
said=$(env -i PATH=/usr/bin:/bin "$work/tcs/bin/tcsim" exec -- \
  sh -c 'a=$(date +%s%N); sleep 3600; echo $(($(date +%s%N) - a))')
((said >= 3600000000000 && said < 3660000000000)) || fail "an hour's sleep took $said ns"
