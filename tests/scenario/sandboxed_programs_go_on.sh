#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A program that asks for Landlock's version, and cuts itself off from whatever that version lets it, as xz does on
# Debian 13, goes on to start threads and children.
# Topics: processes, threads, ordinary programs.
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/sandboxed.py" <<'PY'
import ctypes, os, subprocess, sys, threading
kCreate, kRestrict, kNoNewPrivileges, kMakeLink = 444, 446, 38, 1 << 12
libc = ctypes.CDLL(None, use_errno=True)

class Rules(ctypes.Structure):
    _fields_ = [("files", ctypes.c_uint64), ("net", ctypes.c_uint64), ("scoped", ctypes.c_uint64)]

version = libc.syscall(kCreate, None, 0, 1)
print("version", version, flush=True)
if "ask" in sys.argv: sys.exit()
rules = Rules(kMakeLink, 0, 3 if version >= 6 else 0)
fd = libc.syscall(kCreate, ctypes.byref(rules), 24 if version >= 6 else 8, 0)
assert fd >= 0, os.strerror(ctypes.get_errno())
assert libc.prctl(kNoNewPrivileges, 1, 0, 0, 0) == 0
assert libc.syscall(kRestrict, fd, 0) == 0, os.strerror(ctypes.get_errno())
try:
    os.symlink("a", "b")
except PermissionError:
    print("is kept from links", flush=True)
thread = threading.Thread(target=lambda: print("a thread", flush=True))
thread.start()
thread.join()
subprocess.run(["echo", "a child"])
PY
cd "$folder"
native=$(python3 sandboxed.py ask | cut -d' ' -f2)
((native > 0)) || exit 77 # this kernel has no Landlock
wanted=$(printf 'version %d\nis kept from links\na thread\na child' "$((native < 5 ? native : 5))")
for accounting in measured fixed; do
  said=$("$tcsim" exec --accounting "$accounting" -- python3 sandboxed.py 2>&1) || fail "$accounting: $said"
  said=$(without_waits <<<"$said")
  [[ $said == "$wanted" ]] || fail "$accounting: '$said' instead of '$wanted'"
done
