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
# Natively the machine may stall for longer than a lease or a lifespan: another try.
tries=1
[[ $variant == native ]] && tries=3
for ((try = 1; try <= tries; try++)); do
  status=0
  told=$("$build/bin/in_own_network" "${command[@]}") || status=$?
  # For who adds a scenario; to be read before it is believed.
  [[ -n ${TCS_DDS_RECORD:-} ]] && printf '%s\n' "$told" >"$here/expected/$name.txt"
  diff -u "$here/expected/$name.txt" - <<<"$told" || continue
  ((status == 0)) && exit 0
done
echo "FAILED: $name ($variant): the events differ from what is expected, or the status, $status, is not 0" >&2
exit 1
