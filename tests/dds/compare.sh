#!/usr/bin/env bash
# compare.sh BUILD SCENARIO native|sockets|endpoints DOMAIN: runs a scenario and compares what its
# two processes told with expected/SCENARIO.txt.
set -euo pipefail
build=$(realpath -- "$1") name=$2 variant=$3 domain=$4
here=$(dirname -- "${BASH_SOURCE[0]}")
source "$here/../steadily.sh"
export TCS_DDS_DOMAIN=$domain
export CYCLONEDDS_URI="<CycloneDDS><Domain Id=\"any\"><General>
  <Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces>
</General></Domain></CycloneDDS>"
program=("$build/bin/dds_scenario" "$name" "$variant")
own_network=$build/bin/in_own_network
dds=(--dds "$variant")

complain() {
  echo "FAILED: $name ($1): the events are not those expected, or the status $2 is not 0" >&2
  return 1
}

# agrees HOW COMMAND...: both processes of one program.
agrees() {
  local how=$1 status=0 told
  told=$("$own_network" "${@:2}") || status=$?
  # For who adds a scenario; to be read before it is believed.
  [[ -n ${TCS_DDS_RECORD:-} ]] && printf '%s\n' "$told" >"$here/expected/$name.txt"
  diff -u "$here/expected/$name.txt" - <<<"$told" && ((status == 0)) || complain "$how" "$status"
}

# A process on each of two robots.
agrees_on_two_robots() {
  local status=0 told
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  local option=""
  ((${#dds[@]})) && option=", dds: $variant"
  cat >"$work/scenario.yaml" <<END
duration: 1h
robots:
  left: {clients: {writer: {command: ["${program[0]}", "$name", "$variant", writer, ./meet]$option}}}
  right: {clients: {reader: {command: ["${program[0]}", "$name", "$variant", reader, ./meet]$option}}}
END
  "$own_network" "$build/bin/tcsim" run "$work/scenario.yaml" --out "$work/out" >"$work/said" 2>&1 ||
    status=$?
  local wanted="0 0" ended
  [[ $name == killed_writer ]] && wanted="9 0" && status=0
  [[ $name == killed_reader ]] && wanted="0 9" && status=0
  ended=$(grep -o '"wait_status": [0-9]*' "$work/out/summary.json" | cut -d ' ' -f 2 | xargs) || true
  [[ $ended == "$wanted" ]] || status="of the two, '$ended',"
  told=$(for who in left-writer right-reader; do
    echo "-- ${who#*-}"
    cat "$work/out/$who.out.log"
  done) || status="of no log"
  diff -u "$here/expected/$name.txt" - <<<"$told" && [[ $status == 0 ]] && return
  cat "$work/said" "$work"/out/*.err.log >&2
  complain "$variant, two robots" "$status"
}

if [[ $variant == native ]]; then
  steadily "$build" agrees native "${program[@]}"
else
  # A core for each; both on one, and every run the same; a computer for each.
  agrees "$variant, two cores" "$build/bin/tcsim" exec --cores 2 "${dds[@]}" -- "${program[@]}"
  agrees "$variant, one core" env TCS_DDS_SHARED_CORE=1 "$build/bin/tcsim" exec --accounting fixed \
    "${dds[@]}" -- "${program[@]}"
  agrees_on_two_robots
  # When things happen, to the millisecond.
  if [[ $name == timed_* || $name == full_reader || $name == stopped_reader ]]; then
    agrees "$variant, two cores, set costs" env TCS_DDS_SET_COSTS=1 "$build/bin/tcsim" exec --cores 2 --accounting fixed \
      "${dds[@]}" -- "${program[@]}"
  fi
fi
