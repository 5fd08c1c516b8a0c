// Makes calls that never wait, and handles a signal meanwhile that somebody outside sends, without
// SA_RESTART: none of the calls fails.
#include <errno.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

volatile sig_atomic_t g_handled = 0;

void Expect(bool holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "%s: %s, after %d signals\n", what, strerror(errno), int(g_handled));
  exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  struct sigaction action {};
  action.sa_handler = [](int) { g_handled = g_handled + 1; };
  sigaction(SIGUSR1, &action, nullptr);
  const int wanted = argc > 1 ? atoi(argv[1]) : 1;
  const int file = open("/dev/null", O_WRONLY);
  int word = 0;
  printf("calls as %d\n", getpid());
  fflush(stdout);
  while (g_handled < wanted) {
    const long woken = syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
    Expect(woken == 0, "FUTEX_WAKE");
    Expect(syscall(SYS_sched_yield) == 0, "sched_yield");
    Expect(syscall(SYS_write, file, "x", 1, 0, 0, 0) == 1, "write");
  }
  close(file);
  puts("none failed");
}
