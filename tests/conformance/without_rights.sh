#!/usr/bin/env bash
# without_rights.sh [--in-container|--on-old-kernel|--as-root|--filtered] BUILD COMMAND...: runs `tcsim COMMAND...` where the kernel
# refuses it real-time priorities, and sees to it that the run went without: as somebody without any rights; with
# --in-container also where the calls are refused that Docker refuses to all containers, pidfd_getfd among them; with
# --on-old-kernel there, and without what Linux 5.15 lacks; with --as-root as root who has every capability but
# CAP_SYS_NICE; with --filtered as whoever calls, with all rights, behind a filter that refuses real-time priorities and
# pidfd_getfd. What BUILD has is copied to where everybody may read it; of COMMAND, words that name programs of BUILD are
# the copies then.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/../as_nobody.sh"
situation=nobody
[[ $1 != --* ]] || { situation=${1#--}; shift; }
build=$1
shift
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chmod 755 "$out"
install_for_everybody "$build" "$out" in_container_profile in_old_kernel without_real_time
words=()
for word in "$@"; do
  if [[ $word == "$build"/bin/* ]]; then
    library=$build/bin/lib${word##*/conformance_}_library.so  # that it opens
    [[ ! -e $library ]] || install -m 755 -t "$out/bin" "$library"
    install -m 755 -t "$out/bin" "$word"
    word=$out/bin/${word##*/}
  fi
  words+=("$word")
done
mkdir -m 777 "$out/home"
cd "$out/home"
must_be_refused=
case $situation in
  nobody) as=("${nobody[@]}") ;;
  in-container) as=("${nobody[@]}" "$out/bin/in_container_profile") must_be_refused=1 ;;
  on-old-kernel) as=("${nobody[@]}" "$out/bin/in_container_profile" "$out/bin/in_old_kernel") must_be_refused=1 ;;
  as-root)
    ((EUID == 0)) || { echo 'SKIPPED: it takes root'; exit 77; }
    as=(prlimit --rtprio=0:0 --nice=0:0 setpriv --bounding-set=-sys_nice --inh-caps=-sys_nice)
    ;;
  filtered) as=("$out/bin/without_real_time") must_be_refused=1 ;;
  *) echo "FAILED: there is no situation $situation" >&2; exit 2 ;;
esac
status=0
HOME=$out/home TMPDIR=$out/home "${as[@]}" "$out/bin/tcsim" "${words[@]}" 2>"$out/said" || status=$?
cat "$out/said" >&2
grep -q 'SCHED_FIFO is not permitted here' "$out/said" || { echo 'FAILED: it had the right' >&2; exit 1; }
grep -q 'pidfd_getfd is refused here' "$out/said" && refused=1 || refused=
[[ $refused == "$must_be_refused" ]] || { echo 'FAILED: pidfd_getfd was refused, or should have been' >&2; exit 1; }
exit $status
