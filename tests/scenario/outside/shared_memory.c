/* Two processes share a number. One computes, and changes it each millisecond; the other one looks
 * shortly before and shortly after that, and counts how often it finds something else than what is
 * there at its time. With the argument `unordered` neither says when it looks and changes. */
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <tcs/tcs.h>
#include <unistd.h>

enum { kChanges = 100, kMs = 1000000, kBeside = 200000 };

static void Change(volatile long* number, int64_t start, int ordered) {
  for (int i = 1; i <= kChanges; ++i) {
    while (tcs_now() < start + (int64_t)i * kMs) {
    }
    if (ordered) tcs_write();
    *number = i;
  }
}

static int Look(const volatile long* number, int64_t at, long expected, int ordered) {
  tcs_idle(at);
  if (ordered) tcs_read();
  return *number != expected;
}

int main(int argc, char** argv) {
  const int ordered = argc < 2 || strcmp(argv[1], "unordered") != 0;
  volatile long* number =
      mmap(NULL, sizeof *number, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (number == MAP_FAILED) return 2;
  const int64_t start = tcs_now() + 20 * kMs;
  const pid_t child = fork();
  if (child == 0) {
    Change(number, start, ordered);
    _exit(0);
  }
  int wrong = 0;
  for (int i = 1; i <= kChanges; ++i) {
    wrong += Look(number, start + (int64_t)i * kMs - kBeside, i - 1, ordered);
    wrong += Look(number, start + (int64_t)i * kMs + kBeside, i, ordered);
  }
  waitpid(child, NULL, 0);
  printf("%s, wrong %d\n", tcs_is_running() ? "in a run" : "by itself", wrong);
  return 0;
}
