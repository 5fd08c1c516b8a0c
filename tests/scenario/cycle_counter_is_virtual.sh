#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The processor's cycle counter repeats in fixed runs, also in static programs, and goes on as the clock does. The host's is
# there for who asks for it. Code in which it cannot be replaced is named, once.
# Topics: preloading, timers, determinism, failures.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat >"$work/teller.c" <<'C'
#include <stdio.h>
#include <time.h>
#include <x86intrin.h>
static unsigned long long Ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1000000000ull + now.tv_nsec;
}
int main(void) {
  unsigned processor = 9;
  const unsigned long long begun = Ns(), first = __rdtsc(), second = __rdtscp(&processor);
  printf("%llu %llu %u\n", first, second, processor);
  const struct timespec hour = {3600, 0};
  nanosleep(&hour, NULL);
  _mm_lfence();
  const unsigned long long slept = __rdtsc();
  while (__rdtsc() - slept < 20000000) continue;
  const unsigned long long spun = Ns();
  printf("%llu %.4f %llu\n", slept - second, (double)(__rdtsc() - first) / (double)(Ns() - begun), spun - begun);
}
C
cc -O2 -o "$work/dynamic" "$work/teller.c"
cc -O2 -static -o "$work/static" "$work/teller.c"
for how in dynamic static; do
  for run in 1 2 3; do
    timeout 200 "$tcsim" exec --accounting fixed -- sh -c "$work/$how" >"$work/$how.$run" || fail "$how ends with $?"
    cmp "$work/$how.1" "$work/$how.$run" || fail "fixed runs of the $how program differ"
  done
  # 1 GHz, and a spin of 20 ms after an hour's sleep.
  awk 'NR == 1 && $2 < $1 { exit 1 }
       NR == 2 && !($1 >= 3600e9 && $1 < 3600e9 + 1e6 && $2 > 0.9999 && $2 < 1.0001 && $3 >= 3600.020e9 && $3 < 3600.0202e9) { exit 1 }' \
    "$work/$how.1" || fail "the $how program: $(cat "$work/$how.1")"
done
# Measured it has the host's rate, whatever that is.
said=$(timeout 200 "$tcsim" exec -- "$work/dynamic" | tail -1)
awk '!($1 >= 3600e9 * ($2 - 0.01) && $1 < 3600e9 * ($2 + 0.01) && $2 > 0.5 && $2 < 8) { exit 1 }' <<<"$said" || fail "measured: $said"
# The host's has gone on by less than the hour.
said=$(timeout 200 "$tcsim" exec --rdtsc host -- "$work/dynamic" 2>&1 | without_waits | tail -1)
awk '!($1 < 60e9 && $2 < 0.1) { exit 1 }' <<<"$said" || fail "the host's: $said"

# Calls on both sides of the read, and no room between the functions.
cat >"$work/closed.c" <<'C'
#include <stdio.h>
__asm__(
    ".text\n\tReturn:\n\t.cfi_startproc\n\tret\n\t.rept 200\n\tincl %eax\n\t.endr\n\tret\n\t.cfi_endproc\n"
    "ReadBetweenCalls:\n\t.cfi_startproc\n\tcall Return\n\trdtsc\n\tcall Return\n\tret\n\t.cfi_endproc\n"
    ".globl ReadBetweenCalls\n"
    "Behind:\n\t.cfi_startproc\n\t.rept 200\n\tincl %eax\n\t.endr\n\tret\n\t.cfi_endproc\n");
unsigned ReadBetweenCalls(void);
int main(void) { printf("%d\n", ReadBetweenCalls() == ReadBetweenCalls()); }
C
cc -O1 -o "$work/closed" "$work/closed.c"
said=$(timeout 200 "$tcsim" exec -- sh -c "$work/closed; $work/closed" 2>&1 | without_waits)
[[ $said == "tcsim: "*"sh reads the processor's cycle counter (rdtsc) in $work/closed (at 0x"*"), where tcs cannot replace the instruction"*$'\n0\n0' ]] ||
  fail "what cannot be replaced: $said"
said=$(timeout 200 "$tcsim" exec --rdtsc host -- sh -c "$work/closed" 2>&1 | without_waits)
[[ $said == 0 ]] || fail "the host's counter is warned of: $said"

# Code that is made as the program runs; the first piece does not read the counter.
cat >"$work/maker.c" <<'C'
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
static unsigned long Run(const char* code, int size) {
  char* at = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  memcpy(at, code, size);
  mprotect(at, 4096, PROT_READ | PROT_EXEC);
  return ((unsigned long (*)(void))at)();
}
int main(void) {
  printf("%lu\n", Run("\xb8\x0f\x31\x00\x00\xc3", 6));
  fflush(stdout);
  printf("%d\n", Run("\x0f\x31\x48\xc1\xe2\x20\x48\x09\xd0\xc3", 10) > 0);
}
C
cc -O1 -o "$work/maker" "$work/maker.c"
said=$(timeout 200 "$tcsim" exec -- "$work/maker" 2>&1 | without_waits)
[[ $said == "12559"*"maker reads the processor's cycle counter (rdtsc) in code that it makes as it runs, where"*$'\n1' ]] || fail "code that is made: $said"
said=$(timeout 200 "$tcsim" exec --rdtsc host -- "$work/maker" 2>&1 | without_waits)
[[ $said == $'12559\n1' ]] || fail "code that is made, by the host's counter: $said"

cat >"$work/scenario.yaml" <<END
duration: 1h
robots: {r: {clients: {c: {command: [$work/dynamic], rdtsc: host}}}}
END
"$tcsim" check "$work/scenario.yaml" >"$work/said" 2>&1 || fail "the key: $(cat "$work/said")"
sed -i 's/rdtsc: host/rdtsc: hots/' "$work/scenario.yaml"
"$tcsim" check "$work/scenario.yaml" >"$work/said" 2>&1 && fail "rdtsc: hots is taken"
grep -q "rdtsc.*unknown 'hots'.*host" "$work/said" || fail "rdtsc: hots: $(cat "$work/said")"
