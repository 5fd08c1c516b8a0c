#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What tcsim exec warns of stands where it happened in what the program says on its stderr.
# Topics: failures.
said=$(timeout 150 "$tcsim" exec -- python3 -c '
import os, sys, time
read_end, write_end = os.pipe()
other_read, other_write = os.pipe()
print("first", file=sys.stderr)
if os.fork() == 0:
    time.sleep(0.2)
    os.write(write_end, b"x")
    os._exit(0)
os.splice(read_end, other_write, 1)
print("last", file=sys.stderr)
os.wait()
' 2>&1 >/dev/null) || fail "status $?: $said"
[[ $(without_waits <<<"$said") == first$'\n'"tcsim: warning: python3 blocked in splice (system call 275) of "*"python3"*", a call that the shim does not know"*$'\n'last ]] || fail "said: $said"
