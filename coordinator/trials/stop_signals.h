// SIGINT, SIGTERM and SIGHUP as a descriptor, for a process that waits for other things as well.
#pragma once

#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <optional>

#include "coordinator/os/stop_request.h"
#include "coordinator/port/clocks.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {

class StopSignals {
 public:
  // The signals are blocked from here on, in this process's only thread.
  StopSignals() {
    sigset_t stops;
    sigemptyset(&stops);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&stops, signal);
    sigprocmask(SIG_BLOCK, &stops, nullptr);
    fd_.Reset(signalfd(-1, &stops, SFD_CLOEXEC | SFD_NONBLOCK));
  }

  // Readable when a signal has come.
  int fd() const { return fd_.get(); }
  // Takes the signals that have come. True if the first signal is among them.
  bool Take() {
    const bool asked_before = request_.asked();
    signalfd_siginfo info;
    while (read(fd_.get(), &info, sizeof info) == sizeof info) {
      request_.Take(static_cast<int>(info.ssi_signo), HostClockNs(CLOCK_MONOTONIC));
    }
    return !asked_before && request_.asked();
  }
  const StopRequest& request() const { return request_; }

 private:
  UniqueFd fd_;
  StopRequest request_;
};

}  // namespace tcs
