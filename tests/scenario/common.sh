# Shared by the scenario tests: the command under test, and how a test says that something is wrong.
set -euo pipefail
build=$1
source_root=$2
tcsim=$build/bin/tcsim
if [[ ${3:-} == in_container ]]; then
  export TCS_BUILD=$build
  tcsim=$source_root/tests/scenario/contained_tcsim.sh
fi
# The process that coordinates the run whose tcsim has this number: tcsim > its keeper > it.
coordinator_of() { pgrep -P "$(pgrep -P "$1")"; }
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
# What is in /dev/shm by now and was not when the test began: other runs' files come and go.
shared_at_start=$(ls /dev/shm)
new_in_shm() { comm -13 <(sort <<<"$shared_at_start") <(ls /dev/shm | sort); }
