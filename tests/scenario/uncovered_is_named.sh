#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Each call that takes real time is named when it is first used, once. The calls get arguments that
# make no sense: the warning comes before anything else, and they end a child at worst.
mapfile -t names < <(sed -n 's/^warns | \([^|]*\) |.*/\1/p' "$source_root/tests/coverage/coverage.txt" | tr ' ' '\n')
program='
import ctypes, os, sys
for name in sys.argv[1:]:
    child = os.fork()
    if child == 0:
        for again in range(2):
            getattr(ctypes.CDLL(None), name)(-1, 0, 0, 0, 0)
        os._exit(0)
    os.waitpid(child, 0)
'
said=$(timeout 60 "$tcsim" exec -- python3 -c "$program" "${names[@]}" 2>&1)
for name in "${names[@]}"; do
  count=$(grep -cw "uses $name" <<<"$said" || true)
  ((count == 1)) || fail "$name was named $count times: $said"
done
