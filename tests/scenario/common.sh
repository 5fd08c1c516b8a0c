# Shared by the scenario tests: the command under test, and how a test says that something is wrong.
set -euo pipefail
build=$1
source_root=$2
tcsim=$build/bin/tcsim
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
