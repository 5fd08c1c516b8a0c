#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Runtimes that make threads and processes in their own ways, under set costs: ThreadSanitizer, jemalloc's background
# thread, threads by a handle, libfaketime, stacks of 16 KiB, Qt's QProcess, Python's pools. Each takes its own time to
# 1 %, prints the same in so many runs (third argument), and ends at so many costs of a call from 0.1 to 10 us (fourth).
# Topics: determinism, threads, processes, languages, preloading.
rounds=${3:-1} costs=${4:-2}
programs=$source_root/tests/scenario/runtimes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

says_ns() {  # NAME WANTED_NS SAID
  [[ $3 =~ ^[0-9]+$ ]] || fail "$1 says '$3'"
  (($3 >= $2 && $3 - $2 <= $2 / 100)) || fail "$1: $3 ns, and $2 are right"
}
# Costs from 0.1 to 10 us, each so much more than the one before; so many from one program to the next.
list_costs() { awk -v n="$costs" 'BEGIN { for (i = 0; i < n; ++i) printf "%d\n", 100 * 100 ^ (n > 1 ? i / (n - 1) : 0.5) + 0.5 }'; }

# Of what is printed a number of ns is WANTED_NS; where that is 0 the program says by itself what is not right.
repeats() {  # NAME WANTED_NS CORES COMMAND...
  local name=$1 wanted=$2 cores=$3 first='' said cost i
  shift 3
  for ((i = 0; i < rounds; ++i)); do
    said=$(timeout 200 "$tcsim" exec --accounting fixed --cores "$cores" -- "$@" 2>"$name.stderr") ||
      fail "$name, $cores cores, round $i: status $?: $said $(cat "$name.stderr")"
    ((wanted == 0)) || says_ns "$name" "$wanted" "$said"
    [[ $said != *"that is not"* ]] || fail "$name: $said"
    if ((apart == 0)); then
      [[ $said == "${first:=$said}" ]] || fail "$name, $cores cores, round $i: $said, and before: $first"
    else
      ((${first:=$said} - said <= apart && said - first <= apart)) || fail "$name: $said, and $first before"
    fi
  done
  for cost in $(list_costs); do
    said=$(timeout 200 "$tcsim" exec --accounting fixed --cores "$cores" --call-cost "${cost}ns" -- "$@" 2>"$name.stderr") ||
      fail "$name, $cores cores, $cost ns a call: status $?: $said $(cat "$name.stderr")"
    # What it does beside its waits takes longer then.
    ((wanted == 0 || said >= wanted && said - wanted <= wanted / 10)) || fail "$name, $cost ns a call: $said"
  done
}

# Whoever makes a thread past the shim computes for some microseconds beside it.
apart=10000
beside repeats "a thread by a handle" 800000000 1 python3 "$programs/by_handle.py"
apart=0
cc -O1 -pthread -o stacks "$programs/small_stacks.c"
beside repeats "small stacks" 8000000000 1 ./stacks
all_done
for compiler in g++ clang++; do
  # What does not run natively (on a kernel that lays memory out in another way) is not to be had here.
  command -v $compiler >/dev/null && $compiler -O1 -fsanitize=thread -o $compiler.turns "$programs/turns.cc" 2>/dev/null || continue
  timeout 60 ./$compiler.turns >/dev/null 2>&1 || continue
  beside repeats "ThreadSanitizer of $compiler" 2400000000 1 ./$compiler.turns
done
all_done
jemalloc=$(library 'libjemalloc.so.2 .*x86-64')
if [[ -n $jemalloc ]]; then
  cc -O1 -pthread -o purges "$programs/purges.c"
  beside repeats jemalloc 61000000000 1 env MALLOC_CONF=background_thread:true LD_PRELOAD="$jemalloc" ./purges
fi
faketime=$(find /usr/lib /usr/local/lib -name libfaketimeMT.so.1 -print -quit 2>/dev/null || true)
if [[ -n $faketime ]]; then
  cc -O1 -pthread -o dates "$programs/other_date.c"
  beside repeats libfaketime 1500000000 1 env LD_PRELOAD="$faketime" FAKETIME=-20y ./dates
fi
all_done
for qt in 5 6; do
  flags=$(pkg-config --cflags --libs Qt${qt}Core 2>/dev/null) || continue
  g++ -O1 -fPIC -o qt$qt "$programs/starts.cc" $flags || fail "Qt $qt"
  beside repeats "Qt $qt" 0 1 ./qt$qt
done
all_done
((rounds > 1)) && pools="2 3 4 8" || pools="2 8"
for workers in $pools; do
  for cores in 1 4; do beside repeats "pools of $workers on $cores" 0 $cores python3 "$programs/pool.py" $workers; done
  all_done
done
