#!/usr/bin/env bash
# The paper's experiment and what it left open, from trials to the page: docs/EXPERIMENT.md.
# `./dev experiment` calls it. What is done already is not done again, so that it can be interrupted.
set -euo pipefail

usage() {
  cat <<'END'
usage: ./dev experiment [--quick] [--jobs N] [--out DIR]

  --quick     fewer, shorter trials: the same picture in minutes instead of an hour
  --jobs N    trials at once, each on a CPU of its own; as many as there are CPUs unless told
  --out DIR   where results and report.html go; out/experiment (with --quick out/experiment-quick) unless told

Call it again after an interruption: it goes on where it was.
END
}

die() { printf './dev experiment: %s\n' "$*" >&2; exit 2; }

build=${1:?the build folder}
shift
quick=false out= jobs=$(nproc)
while (($#)); do
  case "$1" in
    --quick) quick=true ;;
    --jobs) jobs=${2:?./dev experiment: --jobs needs a number}; shift ;;
    --out) out=${2:?./dev experiment: --out needs a folder}; shift ;;
    -h | --help) usage; exit ;;
    *) usage >&2; die "there is no option '$1'" ;;
  esac
  shift
done

if $quick; then
  out=${out:-out/experiment-quick}
  trials=2 sweep_trials=1 callback_duration=8s duration=20s sweep_duration=10s
  lengths=10s,20s,40s speeds=0.5,1,2,4
else
  out=${out:-out/experiment}
  trials=10 sweep_trials=3 callback_duration=20s duration=20s sweep_duration=20s
  lengths=20s,60s,180s speeds=0.25,0.5,1,2,4,8
fi

tcsim="$build/bin/tcsim"
scenario="$build/examples/predator_prey/scenario.yaml"
speed=robots.predator.cpu.speed
client=robots.predator.clients
# Plans are executed as they are: feedback would lead back to where the ship was when its plan was asked
# for, at any speed.
as_planned="$client.controller.command=[./predator_controller, --kp, '0', --kd, '0']"
# As much thinking for each plan as fits into some half a second at speed 1, however long it takes.
same_work="$client.planner.command=[./predator_planner, --iterations, '20000', --seed, '\${seed}']"

failed=()
results=()

# series FOLDER LABEL ARGUMENTS of `tcsim trials`
series() {
  local folder="$out/$1" label=$2 status=0
  shift 2
  printf '\n%s\n' "$label"
  "$tcsim" trials "$scenario" --jobs "$jobs" --out "$folder" --name "$label" "$@" || status=$?
  case $status in
    0 | 3) ;;  # 3: some computer is slower than the scenario expects, which a series may be about
    1) failed+=("$label") ;;  # some trials failed, which it named; the others count
    *) exit "$status" ;;
  esac
  results+=("$folder")
}

series tcs "tcs" --trials "$trials" --duration "$duration"
series callback-ode "callback on ODE" --trials "$trials" --duration "$callback_duration" \
  --sync callback --set dynamics.engine=ode
series callback-simbody "callback on Simbody" --trials "$trials" --duration "$callback_duration" \
  --sync callback
series lengths "tcs, longer and longer" --trials 1 --vary "duration=$lengths"
series speeds "a second for each plan" --trials "$sweep_trials" --duration "$sweep_duration" \
  --set "$as_planned" --vary "$speed=$speeds"
series speeds-same-work "the same work for each plan" --trials "$sweep_trials" \
  --duration "$sweep_duration" --set "$as_planned" --set "$same_work" --vary "$speed=$speeds"

printf '\nWhat a stock OMPL planner explores in one second of its own clock\n'
explored="$out/explored.txt"
if ! [[ -s $explored ]]; then
  rounds=5
  $quick && rounds=3
  "$build/bin/tcs_bench" --only planning --rounds "$rounds" >"$explored.new"
  mv "$explored.new" "$explored"
fi
cat "$explored"

printf '\n'
"$tcsim" report "${results[@]}" --bodies predator,prey --mark 5 --out "$out/report.html"
((${#failed[@]} == 0)) || die "trials failed (named above) in: ${failed[*]}"
