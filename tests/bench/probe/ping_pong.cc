#include "tests/bench/probe/ping_pong.h"

#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/bench/probe/batches.h"

namespace tcs::bench {

namespace {

constexpr int kPingPongPriority = 12;

// Until the other side closes its end.
[[noreturn]] void Echo(int in, int out) {
  char byte;
  while (read(in, &byte, 1) == 1 && write(out, &byte, 1) == 1) {
  }
  _exit(0);
}

}  // namespace

double PingPongTicks() {
  const sched_param param{kPingPongPriority};
  if (sched_setscheduler(0, SCHED_FIFO, &param) != 0) return -1;
  int there[2], back[2];
  if (pipe(there) != 0 || pipe(back) != 0) return -1;
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) return -1;
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    close(there[1]);
    close(back[0]);
    Echo(there[0], back[1]);
  }
  close(there[0]);
  close(back[1]);
  bool answered = true;
  const double ticks = TicksPerCall({100, 50}, [&] {
    char byte = 0;
    answered = answered && write(there[1], &byte, 1) == 1 && read(back[0], &byte, 1) == 1;
  });
  close(there[1]);
  waitpid(child, nullptr, 0);
  return answered ? ticks : -1;
}

}  // namespace tcs::bench
