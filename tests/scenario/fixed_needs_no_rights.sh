#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Who may not have a real-time priority runs the same worlds under --accounting fixed, and what is written is
# the same to the byte: by threads, children, births and ends, signals, pipes, and the example's flight.
((EUID == 0)) || exit 77  # to have both
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chmod 755 "$out"
install -D -m 755 -t "$out/bin" "$tcsim" "$build/bin/soak_client"
install -D -m 755 -t "$out/lib" "$build"/lib/libtcs_{preload,allocations,dds}.so
mkdir -m 777 "$out/with" "$out/without"
nobody=(prlimit --rtprio=0:0 --nice=0:0 setpriv --reuid=65534 --regid=65534 --clear-groups --bounding-set=-all
        --inh-caps=-all)

{
  printf 'duration: 2s\ndynamics: {}\nbodies: {ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}}\nrobots:\n'
  for robot in 1 2; do
    printf '  robot%s:\n    cpu: {cores: %s}\n    clients:\n' $robot $robot
    for kind in periodic bursts threads births children stream datagrams signals descriptors; do
      printf '      %s%s: {command: [%s, %s, "3"], priority: %s}\n' \
        $kind $robot "$out/bin/soak_client" $kind $((robot % 2))
    done
  done
} >"$out/world.yaml"

fly() {  # FOLDER COMMAND...
  local folder=$1
  shift
  env -i PATH="$PATH" HOME=/ timeout 80 "$@" run "$out/world.yaml" --accounting fixed --out "$out/$folder/run" \
    >"$out/$folder/said" 2>&1 || fail "$(cat "$out/$folder/said")"
}
fly with "$out/bin/tcsim"
fly without "${nobody[@]}" "$out/bin/tcsim"
! grep -q 'SCHED_FIFO is not permitted here' "$out/with/said" || exit 77
grep -q 'SCHED_FIFO is not permitted here' "$out/without/said" || fail 'it ran with rights'
for file in bodies.csv dispatches.csv activations.csv trace.json; do
  [[ -s $out/with/run/$file ]] || fail "no $file"
  cmp "$out/with/run/$file" "$out/without/run/$file" || fail "$file depends on rights"
done
