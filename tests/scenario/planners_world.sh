# For the tests of planners that are always behind: flies one of each of $kinds, and a source for them
# all, for 3 s into "$out/out"; each says that it is done.
#   fly_planners COMMAND: as in a scenario, with KIND for which it is to be
fly_planners() {
  {
    echo "duration: 3s"
    echo "robots:"
    for kind in source "${kinds[@]}"; do
      echo "  $kind: {clients: {c: {command: ${1//KIND/$kind}}}}"
    done
  } >"$out/scenario.yaml"
  timeout 200 "$tcsim" run "$out/scenario.yaml" --out "$out/out" >"$out/said" 2>"$out/stderr" ||
    fail "$(cat "$out/stderr")"
  for kind in "${kinds[@]}"; do
    grep -q done "$out/out/$kind-c.out.log" || fail "$kind: $(cat "$out/out/$kind-c".*.log)"
  done
}
