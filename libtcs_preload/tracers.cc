// Debuggers and tracers inside a run would wait for ever for stops of their program that nobody
// tells them of. Tracing is refused, with a sentence that says what works instead.
#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>

#include <atomic>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"

using namespace tcs::preload;

namespace {

// For this process, and for the processes that it forks.
std::atomic<bool> g_has_said{false};

void SayOnce() {
  if (g_has_said.exchange(true)) return;
  static const char kSentence[] =
      "tcs: a debugger or tracer cannot work inside a run, because it does not learn when its "
      "program stops; start the program without it, and attach to it from outside (gdb -p PID, "
      "strace -p PID), or open a client of a scenario with `tcsim run --gdb ROBOT/CLIENT`\n";
  RawSyscall(SYS_write, 2, Arg(kSentence), sizeof kSentence - 1);
}

}  // namespace

// As the kernel refuses a process that may not trace.
TCS_EXPORT long ptrace(__ptrace_request request, ...) noexcept {
  va_list list;
  va_start(list, request);
  const long pid = va_arg(list, int);
  void* address = va_arg(list, void*);
  void* data = va_arg(list, void*);
  va_end(list);
  const bool begins =
      request == PTRACE_TRACEME || request == PTRACE_ATTACH || request == PTRACE_SEIZE;
  if (begins && Current() != nullptr) {
    SayOnce();
    return Fail(EPERM);
  }
  // Reading words: the C library gives them back as the result.
  long word = 0;
  const bool peeks =
      request == PTRACE_PEEKTEXT || request == PTRACE_PEEKDATA || request == PTRACE_PEEKUSER;
  const long result =
      ToErrno(RawSyscall(SYS_ptrace, request, pid, Arg(address), peeks ? Arg(&word) : Arg(data)));
  if (!peeks || result < 0) return result;
  errno = 0;
  return word;
}
