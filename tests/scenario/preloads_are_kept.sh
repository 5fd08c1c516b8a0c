#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What the user preloads is there beside the shim, and before it: set around tcsim, in a scenario,
# or by a program for its children. Nobody who sets LD_PRELOAD, or empties the environment, loses the shim.
# Topics: preloading, processes.
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
unset PYTHONUNBUFFERED LD_PRELOAD

# The C library holds back what it prints to a pipe until its program ends; under stdbuf each line
# is there at once.
cat >printer.py <<'PY'
import ctypes, time
libc = ctypes.CDLL(None)
for _ in range(3):
    libc.puts(b"line")
    time.sleep(100)
PY
cat >reader.py <<'PY'
import sys, time
start = time.monotonic()
for line in iter(sys.stdin.readline, ""):
    print(round((time.monotonic() - start) / 100), end=" ")
print()
PY
held='python3 printer.py | python3 reader.py'
at_once='stdbuf -oL python3 printer.py | python3 reader.py'
# Both accountings beside each other.
in_each_mode() {  # FUNCTION
  local mode checks=() check
  for mode in measured fixed; do "$1" "$mode" & checks+=($!); done
  for check in "${checks[@]}"; do wait "$check" || exit 1; done
}
prints() {  # MODE
  local mode=$1 run says
  run=(timeout 200 "$tcsim" exec --accounting "$mode" -- sh -c)
  says=$("${run[@]}" "$held")
  [[ $says == "3 3 3 " ]] || fail "$mode, without stdbuf: '$says'"
  says=$("${run[@]}" "$at_once")
  [[ $says == "0 1 2 " ]] || fail "$mode, stdbuf inside: '$says'"
  says=$(stdbuf -oL "${run[@]}" "$held")
  [[ $says == "0 1 2 " ]] || fail "$mode, stdbuf around tcsim: '$says'"
}
in_each_mode prints

# A whole list of one's own, none, and an empty environment: virtual time goes on.
slept='import os, time; a = time.monotonic(); time.sleep(1000); print(round(time.monotonic() - a), os.environ.get("LD_PRELOAD", ""))'
buf=$(dirname "$(command -v stdbuf)")/../libexec/coreutils/libstdbuf.so
[[ -r $buf ]] && buf=$(realpath "$buf") || fail "there is no $buf"
shim="[^: ]*/libtcs_preload.so"
lists() {  # PATTERN COMMAND...
  local says pattern=$1
  shift
  says=$(timeout 200 "$@" 2>&1)
  says=$(without_waits <<<"$says")
  [[ $says =~ ^1000\ $pattern$ ]] || fail "'$says' instead of '1000 $pattern': $*"
}
lists "$shim" "$tcsim" exec -- python3 -c "$slept"
lists "$shim" "$tcsim" exec -- env -i "$(command -v python3)" -c "$slept"
lists "$shim" "$tcsim" exec -- env -u LD_PRELOAD -u TCS_SOCKET python3 -c "$slept"
lists "$buf:$shim" "$tcsim" exec -- env LD_PRELOAD="$buf" python3 -c "$slept"
lists "$buf:$shim" "$tcsim" exec -- sh -c 'LD_PRELOAD="$LD_PRELOAD $0" exec python3 -c "$1"' "$buf" "$slept"
lists "$buf:$shim" "$tcsim" exec -- sh -c 'LD_PRELOAD="$0" sh -c "exec env python3 -c \"\$0\"" "$1"' "$buf" "$slept"
lists "$buf:$shim" env LD_PRELOAD="$buf" "$tcsim" exec -- python3 -c "$slept"
lists "$buf:$shim:[^: ]*/libtcs_allocations.so" env LD_PRELOAD="$buf" "$tcsim" exec --accounting fixed -- python3 -c "$slept"
# It is for programs: tcsim itself has none of it.
env LD_PRELOAD="$buf" "$tcsim" exec -- sh -c 'tr "\0" "\n" </proc/$PPID/maps' >maps 2>/dev/null
grep -q '^' maps || fail "tcsim's map cannot be read"
grep -q stdbuf maps && fail "tcsim has preloaded what is for programs"

cat >scenario.yaml <<YAML
duration: 2000s
robots: {r: {clients: {c: {command: [python3, -c, '$slept'], environment: {LD_PRELOAD: "$buf"}}}}}
YAML
"$tcsim" run scenario.yaml --out out >/dev/null 2>stderr || fail "$(cat stderr)"
[[ $(cat out/r-c.out.log) =~ ^1000\ $buf:$shim$ ]] || fail "environment: $(cat out/r-c.out.log)"

jemalloc=$(library 'libjemalloc.so.2 .*x86-64')
if [[ -n $jemalloc ]]; then
  maps='import time; time.sleep(1000); print("jemalloc" in open("/proc/self/maps").read())'
  jemalloc_is_there() {  # MODE
    [[ $(LD_PRELOAD=$jemalloc timeout 200 "$tcsim" exec --accounting "$1" -- python3 -c "$maps") == True ]] ||
      fail "$1: jemalloc around tcsim"
    [[ $(timeout 200 "$tcsim" exec --accounting "$1" -- env LD_PRELOAD="$jemalloc" python3 -c "$maps") == True ]] ||
      fail "$1: jemalloc inside"
  }
  in_each_mode jemalloc_is_there
fi

# Programs linked to AddressSanitizer, and such that have it preloaded: it finds what it finds.
command -v g++ >/dev/null || exit 0
cat >checked.cc <<'CC'
#include <cstdio>
#include <cstdlib>
#include <chrono>
#include <thread>
void* lost;
int main(int argc, char** argv) {
  const auto start = std::chrono::steady_clock::now();
  std::thread([] { std::this_thread::sleep_for(std::chrono::seconds(1000)); }).join();
  const auto passed = std::chrono::steady_clock::now() - start;
  printf("%d\n", static_cast<int>(std::chrono::duration<double>(passed).count() + 0.5));
  fflush(stdout);
  char* block = static_cast<char*>(malloc(8));
  if (argc > 1 && *argv[1] == 'o') block[argc + 6] = 1;
  if (argc > 1 && *argv[1] == 'l') std::thread([] { lost = malloc(100); lost = nullptr; }).join();
  free(block);
}
CC
g++ -O0 -fsanitize=address -o checked checked.cc 2>/dev/null || exit 0
asan=$(ldd ./checked | awk '/libasan/ {print $3}')
checks() {  # SAID WORD WANTED COMMAND...
  local status=0 said=$1 word=$2 wanted=$3
  shift 3
  timeout 200 "$@" ./checked "$word" >"$said" 2>&1 || status=$?
  grep -qx 1000 "$said" || fail "$word: no virtual time: $* says $(cat "$said")"
  [[ $wanted == nothing ]] && { ((status == 0)) || fail "status $status: $*: $(cat "$said")"; return; }
  ((status != 0 && status != 124)) || fail "status $status: $*: $(cat "$said")"
  grep -q "$wanted" "$said" || fail "no $wanted: $*: $(cat "$said")"
}
checks_all() {  # MODE
  local mode=$1 run
  for run in "$tcsim exec --accounting $mode --" "$tcsim exec --accounting $mode -- env LD_PRELOAD=$asan" \
    "env LD_PRELOAD=$asan $tcsim exec --accounting $mode --"; do
    checks "$mode.said" in nothing $run
    checks "$mode.said" over heap-buffer-overflow $run
    checks "$mode.said" leak 'detected memory leaks' $run
  done
}
in_each_mode checks_all

# A library that wraps functions and goes on to the C library's other names for them, as libfaketime and proxychains do:
# behind those names there is no way back to it.
cat >twins.c <<'C'
#define _GNU_SOURCE
#include <dlfcn.h>
/* All arguments are in registers. */
#define WRAP(name)                                                 \
  long name(long a, long b, long c, long d, long e, long f) {      \
    static long (*twin)(long, long, long, long, long, long);       \
    if (twin == 0) twin = dlsym(RTLD_NEXT, "__" #name);            \
    return twin(a, b, c, d, e, f);                                 \
  }
WRAP(clock_gettime) WRAP(clock_nanosleep) WRAP(close) WRAP(connect) WRAP(dup2) WRAP(fork) WRAP(nanosleep) WRAP(poll)
WRAP(read) WRAP(sched_getparam) WRAP(sched_getscheduler) WRAP(sched_yield) WRAP(select) WRAP(send) WRAP(sigaction)
WRAP(sysconf) WRAP(wait) WRAP(waitpid) WRAP(write)
C
cc -w -shared -fPIC -o twins.so twins.c -ldl
cat >wrapped.py <<'PY'
import os, select, signal, socket, time
begun = time.monotonic()
signal.signal(signal.SIGUSR1, lambda *_: None)
one, other = socket.socketpair()
address = "\0of-wrapped-%d" % os.getpid()
listener = socket.socket(socket.AF_UNIX); listener.bind(address); listener.listen()
client = socket.socket(socket.AF_UNIX); client.connect(address)
for pause in range(3):
    child = os.fork()
    if child == 0:
        time.sleep(100)
        one.send(b"x")
        os._exit(7)
    poll = select.poll(); poll.register(other, select.POLLIN)
    assert poll.poll(1000000) and os.read(other.fileno(), 1) == b"x" and select.select([other], [], [], 100) == ([], [], [])
    assert os.waitpid(child, 0)[1] == 7 << 8
os.sched_yield(); os.sched_getparam(0); os.sched_getscheduler(0); os.sysconf("SC_OPEN_MAX"); os.dup2(1, 99); os.close(99)
os.write(1, b"%d\n" % round((time.monotonic() - begun) / 100))
PY
wraps() {  # MODE
  local says
  says=$(timeout 200 "$tcsim" exec --accounting "$1" -- env LD_PRELOAD="$folder/twins.so" python3 wrapped.py) ||
    fail "$1, wrapped: status $?"
  [[ $says == 6 ]] || fail "$1, wrapped: '$says'"
}
[[ -z $(LD_PRELOAD="$folder/twins.so" sh -c 'exit 0' 2>&1) ]] || { echo "it cannot wrap here"; exit 0; }
in_each_mode wraps
faketime=$(find /usr/lib /usr/local/lib -name libfaketimeMT.so.1 2>/dev/null | head -n 1)
dates() {  # MODE
  local says
  says=$(timeout 200 "$tcsim" exec --accounting "$1" -- env LD_PRELOAD="$faketime" FAKETIME='@2001-02-03 04:05:06' \
    sh -c 'echo $$ >"$0"; date +%F; sleep 86400; date +%F' "of_faketime.$1") || fail "$1, libfaketime: status $?"
  # The library leaves them, also natively, where the shell that it was loaded into first ends.
  rm -f "/dev/shm/faketime_shm_$(<"of_faketime.$1")" "/dev/shm/sem.faketime_sem_$(<"of_faketime.$1")"
  [[ $says == $'2001-02-03\n2001-02-0'[34] ]] || fail "$1, libfaketime: $says"
}
[[ -z $faketime ]] || in_each_mode dates
