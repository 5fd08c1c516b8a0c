#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# tcs is a kernel without io_uring. Programs that can do without do so and nothing is said; one that fails for it is
# told why.
# Topics: ordinary programs, failures, languages.
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
# liburing itself, by the function that makes a ring.
cat >ring.py <<'PY'
import ctypes, errno, sys, time
ring = ctypes.create_string_buffer(4096)
begun = time.monotonic()
made = ctypes.CDLL("liburing.so.2").io_uring_queue_init(8, ring, 0)
assert made in (0, -errno.ENOSYS, -errno.EPERM), made
if made < 0 and sys.argv[1] == "needs":
    sys.exit("no ring: " + errno.errorcode[-made])
time.sleep(2)
print(errno.errorcode[-made] if made else "ring", round(time.monotonic() - begun, 1))
PY
sentence='asked for io_uring, which tcs refuses (ENOSYS, as a kernel without it does), and failed'
library 'liburing[.]so[.]2' | grep -q . || exit 77
for mode in measured fixed; do
  said=$("$tcsim" exec --accounting "$mode" -- python3 ring.py does-without 2>err) || fail "$(cat err)"
  [[ $said == 'ENOSYS 2.0' ]] || fail "$mode: $said"
  ! grep -q io_uring err || fail "$mode: $(cat err)"
  # Also of a program that another one has started.
  for how in 'python3 ring.py needs' 'bash -c "python3 ring.py needs; exit 3"'; do
    status=0
    eval "\"\$tcsim\" exec --accounting $mode -- $how" 2>err || status=$?
    ((status != 0)) && grep -q 'no ring: ENOSYS' err || fail "$mode: $how: $status $(cat err)"
    grep -qF "$sentence" err || fail "$mode: $how: $(cat err)"
  done
  ! command -v node >/dev/null ||
    { said=$(UV_USE_IO_URING=1 "$tcsim" exec --accounting "$mode" -- node -e '
        const begun = process.hrtime.bigint();
        require("fs").promises.readFile("ring.py").then(read => setTimeout(() =>
          console.log(read.length > 100, Math.round(Number(process.hrtime.bigint() - begun) / 1e9)), 3000))' 2>err)
      [[ $said == 'true 3' ]] && ! grep -q io_uring err || fail "$mode: node: $said $(cat err)"; }
done
