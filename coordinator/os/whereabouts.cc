#include "coordinator/os/whereabouts.h"

#include <execinfo.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

#include <cstddef>

namespace tcs {

namespace {

constexpr int kFatalSignals[] = {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL};
constexpr int kMostFrames = 32;
constexpr int kOwnFrames = 2;  // the handler, and what the kernel returns by

// The handler's own stack: the thread's may be what has overflowed.
alignas(16) char g_stack[64 * 1024];

// Runs once: then the signal does what it does by default.
void TellAndDie(int signal) {
  constexpr char kIntroduction[] = "tcsim: for the report, where it was (as addr2line takes it):\n";
  const bool can_speak = write(STDERR_FILENO, kIntroduction, sizeof kIntroduction - 1) > 0;
  void* frames[kMostFrames];
  const int count = can_speak ? backtrace(frames, kMostFrames) : 0;
  if (count > kOwnFrames) {
    backtrace_symbols_fd(frames + kOwnFrames, count - kOwnFrames, STDERR_FILENO);
  }
  raise(signal);
}

}  // namespace

void TellWhereItDies() {
  // The first call loads a library, which no handler may do.
  void* frame = nullptr;
  backtrace(&frame, 1);
  stack_t stack{};
  stack.ss_sp = g_stack;
  stack.ss_size = sizeof g_stack;
  sigaltstack(&stack, nullptr);
  for (const int signal : kFatalSignals) {
    struct sigaction action {};
    if (sigaction(signal, nullptr, &action) != 0 || action.sa_handler != SIG_DFL) continue;
    action.sa_handler = TellAndDie;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_ONSTACK);
    sigaction(signal, &action, nullptr);
  }
}

}  // namespace tcs
