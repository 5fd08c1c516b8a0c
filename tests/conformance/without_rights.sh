#!/usr/bin/env bash
# without_rights.sh [--in-container] BUILD COMMAND...: runs `tcsim COMMAND...` as somebody without any rights, real-time
# priority among them, and sees to it that the run went without; with the option also where the calls are refused
# that Docker refuses to all containers, pidfd_getfd among them. What BUILD has is copied to where everybody may
# read it; of COMMAND, words that name programs of BUILD are the copies then.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/../as_nobody.sh"
in_container=
[[ $1 != --in-container ]] || { in_container=1; shift; }
build=$1
shift
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chmod 755 "$out"
install_for_everybody "$build" "$out" in_container_profile
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
as=("${nobody[@]}")
[[ -z $in_container ]] || as+=("$out/bin/in_container_profile")
status=0
HOME=$out/home TMPDIR=$out/home "${as[@]}" "$out/bin/tcsim" "${words[@]}" 2>"$out/said" || status=$?
cat "$out/said" >&2
grep -q 'SCHED_FIFO is not permitted here' "$out/said" || { echo 'FAILED: it had the right' >&2; exit 1; }
grep -q 'pidfd_getfd is refused here' "$out/said" && refused=1 || refused=
[[ $refused == "$in_container" ]] || { echo 'FAILED: pidfd_getfd was refused, or should have been' >&2; exit 1; }
exit $status
