#!/usr/bin/env bash
# compare.sh BUILD SCENARIO native|sockets|endpoints DOMAIN: runs a scenario and compares what its
# two processes told with expected/SCENARIO.txt.
set -euo pipefail
build=$1 name=$2 variant=$3 domain=$4
here=$(dirname -- "${BASH_SOURCE[0]}")
export TCS_DDS_DOMAIN=$domain
export CYCLONEDDS_URI="<CycloneDDS><Domain Id=\"any\"><General>
  <Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces>
</General></Domain></CycloneDDS>"
program=("$build/bin/dds_scenario" "$name" "$variant")
own_network=$build/bin/in_own_network
dds=(--dds "$variant")

# agrees COMMAND...
agrees() {
  local status=0 told
  told=$("$own_network" "$@") || status=$?
  # For who adds a scenario; to be read before it is believed.
  [[ -n ${TCS_DDS_RECORD:-} ]] && printf '%s\n' "$told" >"$here/expected/$name.txt"
  diff -u "$here/expected/$name.txt" - <<<"$told" && ((status == 0)) && return
  echo "FAILED: $name ($variant): the events differ from what is expected, or the status, $status, is not 0" >&2
  return 1
}

if [[ $variant == native ]]; then
  # The machine may stall for longer than a lease or a lifespan: another try.
  agrees "${program[@]}" || agrees "${program[@]}"
else
  for accounting in measured fixed; do
    agrees "$build/bin/tcsim" exec --cores 2 --accounting "$accounting" "${dds[@]}" -- "${program[@]}"
  done
fi
