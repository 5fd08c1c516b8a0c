#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/as_nobody.sh"
# A run may have more processes than its limit of open files at a login lets tcsim follow: tcsim raises its own, and not
# that of its programs. Where it cannot, a sentence says so, and the run ends.
# Topics: processes, failures, rights.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chmod 755 "$out"
install_for_everybody "$build" "$out"
cat >"$out/children.py" <<'PY'
import os, resource, sys, time
print("limit", resource.getrlimit(resource.RLIMIT_NOFILE)[0], flush=True)
begun = time.monotonic()
for _ in range(int(sys.argv[1])):
    if os.fork() == 0:
        time.sleep(100)
        os._exit(0)
for _ in range(int(sys.argv[1])): os.wait()
print("over" if 100 <= time.monotonic() - begun < 110 else "not in time")
PY
chmod 644 "$out/children.py"
many() {  # SOFT:HARD COMMAND...
  said=$(timeout 200 prlimit --nofile="$1" "${@:2}" -- python3 "$out/children.py" 400 2>"$out/stderr")
}
for accounting in measured fixed; do
  many 256:4096 "$tcsim" exec --accounting $accounting || fail "$accounting: $(cat "$out/stderr")"
  [[ $said == $'limit 256\nover' ]] || fail "$accounting: $said"
  many 256:4096 "${nobody[@]}" "$out/bin/tcsim" exec --accounting $accounting ||
    fail "$accounting, without rights: $(cat "$out/stderr")"
  [[ $said == $'limit 256\nover' ]] || fail "$accounting, without rights: $said"
  ! many 256:256 "$tcsim" exec --accounting $accounting || fail "$accounting: $said, with a limit of 256"
  grep -q '^tcsim: this run may have 256 files open, and needs several for each of its processes' "$out/stderr" ||
    fail "$accounting: $(cat "$out/stderr")"
done
