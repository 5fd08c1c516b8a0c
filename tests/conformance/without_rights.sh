#!/usr/bin/env bash
# without_rights.sh BUILD COMMAND...: runs `tcsim COMMAND...` as somebody without any rights, real-time
# priority among them, and sees to it that the run went without. What BUILD has is copied to where
# everybody may read it; of COMMAND, words that name programs of BUILD are the copies then.
set -euo pipefail
build=$1
shift
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chmod 755 "$out"
install -D -m 755 -t "$out/bin" "$build/bin/tcsim"
install -D -m 755 -t "$out/lib" "$build"/lib/libtcs_{preload,allocations,dds}.so
words=()
for word in "$@"; do
  if [[ $word == "$build"/bin/* ]]; then
    install -m 755 -t "$out/bin" "$word"
    word=$out/bin/${word##*/}
  fi
  words+=("$word")
done
mkdir -m 777 "$out/home"
cd "$out/home"
lowered=(prlimit --rtprio=0:0 --nice=0:0)
if ((EUID == 0)); then
  lowered+=(setpriv --reuid=65534 --regid=65534 --clear-groups --bounding-set=-all --inh-caps=-all)
fi
status=0
HOME=$out/home TMPDIR=$out/home "${lowered[@]}" "$out/bin/tcsim" "${words[@]}" 2>"$out/said" || status=$?
cat "$out/said" >&2
grep -q 'SCHED_FIFO is not permitted here' "$out/said" || { echo 'FAILED: it had the right' >&2; exit 1; }
exit $status
