#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/as_nobody.sh"
# Threads that runtimes make for themselves, past the shim: ThreadSanitizer's helper (of GCC and of Clang), jemalloc's
# background thread, one that Python makes through a handle of the C library. None hangs, what their programs do takes
# its own time to 1 % (measured: to 4 %, for what computing costs is the host's), with rights and without; and with set
# costs it is the same in each of so many runs.
# Topics: threads, determinism, languages, preloading, rights.
rounds=${3:-3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"
cd "$work"
install_for_everybody "$build" "$work"
cp "$source_root"/tests/scenario/runtimes/{turns.cc,purges.c,by_handle.py} .
chmod -R a+rX .

expect_ns() {  # WHOSE WANTED_NS SAID [PERCENT]
  [[ $3 =~ ^[0-9]+$ ]] || fail "$1 says '$3'"
  (($3 >= $2 && $3 - $2 <= $2 / 100 * ${4:-1})) || fail "$1: $3 ns, and $2 are right"
}
check() {  # NAME WANTED_NS COMMAND...
  local name=$1 wanted=$2 first='' said i
  shift 2
  expect_ns "$name, measured" "$wanted" "$(timeout 150 "$tcsim" exec -- "$@")" 4
  for i in measured fixed; do
    said=$(timeout 150 "${nobody[@]}" "$work/bin/tcsim" exec --accounting $i -- "$@" 2>stderr) || fail "$name: $(cat stderr)"
    expect_ns "$name, $i, without rights" "$wanted" "$said" $([[ $i == fixed ]] || echo 4)
  done
  for ((i = 0; i < rounds; ++i)); do
    said=$(timeout 150 "$tcsim" exec --accounting fixed -- "$@") || fail "$name, fixed: $said"
    expect_ns "$name, fixed" "$wanted" "$said"
    ((${first:=$said} - said <= apart && said - first <= apart)) || fail "$name: $said, and $first before"
  done
}

# Its maker computes for some microseconds beside the newborn thread, and has Python's lock by then or not.
apart=10000
check "a thread by a handle" 800000000 python3 "$work/by_handle.py"
apart=0
found=0
for compiler in g++ clang++; do
  # What does not run natively (on a kernel that lays memory out in another way) is not to be had here.
  command -v $compiler >/dev/null && $compiler -O1 -fsanitize=thread -o $compiler.turns turns.cc 2>/dev/null || continue
  timeout 60 ./$compiler.turns >/dev/null 2>&1 || continue
  check "ThreadSanitizer of $compiler" 2400000000 "$work/$compiler.turns"
  found=1
done
((found)) || echo "no compiler here has a ThreadSanitizer that runs"
jemalloc=$(library 'libjemalloc.so.2 .*x86-64')
if [[ -n $jemalloc ]]; then
  cc -O1 -o purges purges.c
  check jemalloc 61000000000 env MALLOC_CONF=background_thread:true LD_PRELOAD="$jemalloc" "$work/purges"
fi
