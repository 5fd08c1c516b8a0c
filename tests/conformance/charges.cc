// What a single thread computes takes as much time as it is charged: never more charge than time,
// and who spins on giving way gets on.
#include <sched.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

struct Spent {
  std::int64_t time, charge;
};

template <class Work>
Spent Spend(Work work) {
  const std::int64_t time = Now(), charge = Now(CLOCK_THREAD_CPUTIME_ID);
  work();
  const std::int64_t charged = Now(CLOCK_THREAD_CPUTIME_ID) - charge;
  return {Now() - time, charged};
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  // Natively each may give a loaded host's others their turns.
  const int turns = g_mode == Mode::kNative ? 200 : 20'000;
  const Spent yields = Spend([=] {
    for (int i = 0; i < turns; ++i) sched_yield();
  });
  EXPECT(yields.charge <= yields.time, "yields: charged %lld ns in %lld ns",
         (long long)yields.charge, (long long)yields.time);
  EXPECT(yields.time >= turns * 100, "%d yields took %lld ns", turns, (long long)yields.time);

  // A child sends back each byte.
  int there[2], back[2];
  EXPECT(pipe(there) == 0 && pipe(back) == 0, "pipe");
  const pid_t pid = fork();
  if (pid == 0) {
    close(there[1]);
    char c;
    while (read(there[0], &c, 1) == 1 && write(back[1], &c, 1) == 1) {
    }
    _exit(0);
  }
  const Spent exchanges = Spend([&] {
    char c = 'x';
    for (int i = 0; i < 2'000; ++i) {
      EXPECT(write(there[1], &c, 1) == 1 && read(back[0], &c, 1) == 1, "%s", strerror(errno));
    }
  });
  EXPECT(exchanges.charge <= exchanges.time, "exchanges: charged %lld ns in %lld ns",
         (long long)exchanges.charge, (long long)exchanges.time);
  close(there[1]);
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "child status %x", status);

  const Spent sleeps = Spend([] {
    for (int i = 0; i < 1'000; ++i) usleep(10);
  });
  EXPECT(sleeps.time >= 10 * kMs && sleeps.charge < sleeps.time, "sleeps: charged %lld ns in %lld",
         (long long)sleeps.charge, (long long)sleeps.time);
}
