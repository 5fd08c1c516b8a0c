#!/usr/bin/env bash
# Installs what reads MCAP files in the tests (package.json) into the folder $1/tests/mcap, once, and prints the
# folder. Without node, npm or a network it says what is missing and fails: without a network at once for some minutes after
# the first time, since npm tries for more than one.
set -euo pipefail
build=$1
from=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
to=$build/tests/mcap
for tool in node npm; do
  command -v "$tool" >/dev/null || { echo "$tool is missing, which reads MCAP files here: apt-get install nodejs npm" >&2; exit 1; }
done
mkdir -p "$to"
exec 9>"$to/lock"
flock 9
if ! cmp -s "$from/package-lock.json" "$to/installed"; then
  if [[ -n $(find "$to/failed" -mmin -10 2>/dev/null) ]]; then
    cat "$to/failed" >&2
    exit 1
  fi
  cp "$from/package.json" "$from/package-lock.json" "$to"
  # What is in HOME is the user's business.
  (cd "$to" && npm ci --no-audit --no-fund --ignore-scripts >"$to/log" 2>&1) ||
    { echo "npm could not install the readers of MCAP files: $(tail -n 1 "$to/log"); see $to/log" | tee "$to/failed" >&2; exit 1; }
  cp "$from/package-lock.json" "$to/installed"
fi
# Another test may be reading it just now.
cmp -s "$from/read.mjs" "$to/read.mjs" || { cp "$from/read.mjs" "$to/read.new" && mv "$to/read.new" "$to/read.mjs"; }
printf '%s\n' "$to"
