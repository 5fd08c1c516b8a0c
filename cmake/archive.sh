#!/usr/bin/env bash
# archive.sh BUILD FOLDER: makes FOLDER, a tcs that runs on other Linux distributions than the one that built it, from
# wherever it is unpacked: what `cmake --install` gives, and in lib/carried the libraries that distributions lack or have
# in other versions. Of the C and the C++ library each has its own. `./dev package` packs it.
set -euo pipefail
build=$1 folder=$2
source_root="$(cd -P -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)"
cmake --install "$build" --prefix "$folder" --strip >/dev/null
install -m 755 "$source_root/cmake/install.sh" "$folder/install.sh"
tcs=$(dirname "$(find "$folder/lib" -name libtcs_preload.so)")
carried=$folder/lib/carried
licences=$folder/share/doc/tcsim/carried
mkdir -p "$carried" "$licences"
files=()

programs=("$folder/bin/tcsim" "$tcs/libtcs_physics.so" "$tcs/tcsim-tools" "$tcs/tcsim-view" "$tcs/tcs-dds-gateway")
# Not of libtcs_dds.so: it is for programs that bring their Cyclone DDS.
while read -r library; do
  [[ $library =~ /(libc|libm|libdl|librt|libpthread|libstdc\+\+|libgcc_s)\.so ]] && continue
  cp -L "$library" "$carried/"
  files+=("*/$(basename "$(realpath "$library")")")
done < <(ldd "${programs[@]}" | awk '$2 == "=>" && $3 ~ /^\// { print $3 }' | sort -u)

for package in $(dpkg-query -S "${files[@]}" | sed 's/:.*//' | sort -u); do
  cp -L "/usr/share/doc/$package/copyright" "$licences/$package"
done

for program in "${programs[@]}"; do
  patchelf --set-rpath "\$ORIGIN/$(realpath --relative-to "$(dirname "$program")" "$carried")" "$program"
done
for library in "$carried"/*; do
  chmod 644 "$library"
  patchelf --set-rpath '$ORIGIN' "$library"
done
