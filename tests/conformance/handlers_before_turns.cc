// A handler of a thread whose wait is over may run before the thread has its turn: the kernel held
// the one whose turn it was. What the handler does waits for the thread's own turn, and what the
// thread had waited for is answered all the same.
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

volatile sig_atomic_t g_handled = 0;

// As a test's harness does: whoever is alive puts its end off.
void PutOff(int) {
  g_handled = g_handled + 1;
  alarm(3600);
}

// It tells its parent, and is held by the kernel for what the disk has to write.
[[noreturn]] void TellAndWrite(int file) {
  kill(getppid(), SIGUSR1);
  if (fsync(file) != 0) _exit(1);
  kill(getppid(), SIGUSR1);
  usleep(10);
  _exit(0);
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int kChildren = 20;
  static const char written[4 << 20] = {};
  struct sigaction action {};
  action.sa_handler = PutOff;
  action.sa_flags = SA_RESTART;
  sigaction(SIGUSR1, &action, nullptr);
  char path[] = "/var/tmp/handlers_before_turns.XXXXXX";
  const int file = mkstemp(path);
  EXPECT(file >= 0, "mkstemp: %s", strerror(errno));
  unlink(path);
  for (int i = 0; i < kChildren; ++i) {
    EXPECT(pwrite(file, written, sizeof written, 0) == sizeof written, "%s", strerror(errno));
    const pid_t child = fork();
    EXPECT(child >= 0, "fork: %s", strerror(errno));
    if (child == 0) TellAndWrite(file);
    int status = -1;
    EXPECT(waitpid(child, &status, 0) == child && status == 0, "child %d: status %x", i, status);
    // Several that come at once are one.
    EXPECT(g_handled > i, "%d handlers after %d children", static_cast<int>(g_handled), i + 1);
  }
  EXPECT(alarm(0) >= 3590, "the alarm was not put off");
  Begin(argc, argv);  // at last: after its sleep the parent has its turns before
}
