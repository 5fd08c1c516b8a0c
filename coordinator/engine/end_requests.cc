#include "coordinator/engine/end_requests.h"

#include <poll.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/signalfd.h>
#include <time.h>
#include <unistd.h>

#include "coordinator/os/end_signals.h"
#include "coordinator/port/clocks.h"

namespace tcs {

void EndRequests::Open(Reactor& reactor) {
  const sigset_t blocked = EndSignals();
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  signal(SIGPIPE, SIG_IGN);
  fd_.Reset(signalfd(-1, &blocked, SFD_CLOEXEC | SFD_NONBLOCK));
  reactor.Add(fd_.get(), EPOLLIN, {Tag::kSignal});
}

bool EndRequests::IsPending() const {
  pollfd asked{fd_.get(), POLLIN, 0};
  return poll(&asked, 1, 0) > 0;
}

bool EndRequests::Take(RunState& run) {
  signalfd_siginfo info;
  if (read(fd_.get(), &info, sizeof info) != sizeof info) return false;
  // ^C is for the program that has the terminal.
  if (info.ssi_signo == SIGINT && info.ssi_code == SI_KERNEL &&
      run.options.output_directory.empty()) {
    return false;
  }
  run.stop.Take(static_cast<int>(info.ssi_signo), HostClockNs(CLOCK_MONOTONIC));
  return true;
}

}  // namespace tcs
