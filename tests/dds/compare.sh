#!/usr/bin/env bash
# compare.sh BUILD SCENARIO native|sockets|endpoints DOMAIN: runs a scenario and compares what its
# two processes told with expected/SCENARIO.txt.
set -euo pipefail
build=$1 name=$2 variant=$3 domain=$4
here=$(dirname -- "${BASH_SOURCE[0]}")
export CYCLONEDDS_URI="<CycloneDDS><Domain Id=\"$domain\"><General>
  <Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces>
</General></Domain></CycloneDDS>"
command=("$build/bin/dds_scenario" "$name" "$variant")
if [[ $variant != native ]]; then
  how=()
  [[ ${TCS_DDS_CHOICE:-0} == 1 ]] && how=(--dds "$variant")
  command=("$build/bin/tcsim" exec --cores 2 "${how[@]}" -- "${command[@]}")
fi
status=0
told=$("$build/bin/in_own_network" "${command[@]}") || status=$?
if [[ ${TCS_DDS_RECORD:-} ]]; then
  printf '%s\n' "$told" >"$here/expected/$name.txt"
fi
diff -u "$here/expected/$name.txt" - <<<"$told" || status=1
((status == 0)) || { echo "FAILED: $name ($variant): the events differ, or status $status" >&2; exit 1; }
