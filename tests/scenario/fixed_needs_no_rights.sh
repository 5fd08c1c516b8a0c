#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/as_nobody.sh"
# Who may not have a real-time priority runs the same worlds under --accounting fixed, and what is written is
# the same to the byte: by threads, children, births and ends, signals, pipes, and the example's flight. So it is
# where Docker's default profile refuses pidfd_getfd besides, whether a real-time priority is to be had or not.
# Topics: rights, determinism, containers.
((EUID == 0)) || exit 77  # to have both
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chmod 755 "$out"
install_for_everybody "$build" "$out" soak_client in_container_profile
mkdir -m 777 "$out/with" "$out/without" "$out/contained" "$out/half_contained"

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
  env -i PATH="$PATH" HOME=/ timeout 200 "$@" run "$out/world.yaml" --accounting fixed --out "$out/$folder/run" \
    >"$out/$folder/said" 2>&1 || fail "$(cat "$out/$folder/said")"
}
fly with "$out/bin/tcsim"
fly without "${nobody[@]}" "$out/bin/tcsim"
fly contained "${nobody[@]}" "$out/bin/in_container_profile" "$out/bin/tcsim"
fly half_contained "$out/bin/in_container_profile" "$out/bin/tcsim"
! grep -q 'SCHED_FIFO is not permitted here' "$out/with/said" || exit 77
grep -q 'SCHED_FIFO is not permitted here' "$out/without/said" || fail 'it ran with rights'
grep -q 'pidfd_getfd is refused here' "$out/contained/said" || fail 'pidfd_getfd was permitted'
grep -q 'without SCHED_FIFO, which is permitted' "$out/half_contained/said" || fail 'a right is not named'
for file in bodies.csv dispatches.csv activations.csv trace.json; do
  [[ -s $out/with/run/$file ]] || fail "no $file"
  for less in without contained half_contained; do
    cmp "$out/with/run/$file" "$out/$less/run/$file" || fail "$file depends on rights: $less"
  done
done
