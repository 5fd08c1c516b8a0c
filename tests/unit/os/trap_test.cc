
#include "coordinator/os/trap.h"

#include <errno.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <thread>

#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"
#include "coordinator/port/unique_fd.h"
#include "shm/layout.h"

namespace tcs {
namespace {

std::atomic<int> g_handled{0};

// A thread of this process with the trap, which is this thread's to answer. Like a client's first
// it has no real-time priority.
class TrappedThread {
 public:
  explicit TrappedThread(const std::function<void()>& program)
      : thread_([this, program] {
          listener_ = InstallTrap({});
          if (listener_ >= 0) program();
        }) {
    while (listener_ == kNone) std::this_thread::yield();
  }
  // The kernel carries out whatever it still calls, its end among them.
  ~TrappedThread() {
    const UniqueFd listener(listener_);
    pollfd call{listener.get(), POLLIN, 0};
    while (listener && poll(&call, 1, 60'000) == 1 && (call.revents & POLLIN) != 0) {
      if (const auto rest = ReceiveTrapped(listener.get())) {
        ContinueTrapped(rest->listener, rest->id);
      }
    }
    thread_.join();
  }

  bool is_trapped() const { return listener_ >= 0; }
  pthread_t id() { return thread_.native_handle(); }
  // The next call of that number; others are carried out.
  TrappedCall Await(int number) const {
    for (;;) {
      const auto call = ReceiveTrapped(listener_);
      if (call.has_value() && call->number == number) return *call;
      if (call.has_value()) ContinueTrapped(call->listener, call->id);
    }
  }

 private:
  static constexpr int kNone = -2;
  std::atomic<int> listener_{kNone};
  std::thread thread_;
};

void HandleWith(int flags) {
  struct sigaction action {};
  action.sa_handler = [](int) { ++g_handled; };
  action.sa_flags = flags;
  sigaction(SIGUSR1, &action, nullptr);
}

TEST(Trap, WithoutARealTimePriorityASignalWaitsUntilTheCallIsAnswered) {
  if (!TrapsHoldSignals()) GTEST_SKIP() << "takes Linux 5.19";
  HandleWith(0);
  g_handled = 0;
  std::atomic<long> result{-1};
  {
    TrappedThread thread([&result] { result = syscall(SYS_sched_yield); });
    if (!thread.is_trapped()) GTEST_SKIP() << "no trap here";
    const TrappedCall call = thread.Await(SYS_sched_yield);
    pthread_kill(thread.id(), SIGUSR1);
    usleep(50'000);
    EXPECT_EQ(g_handled, 0);
    EXPECT_TRUE(AnswerTrapped(call.listener, call.id, 7)) << "the signal has ended it";
  }
  EXPECT_EQ(result, 7);
  EXPECT_EQ(g_handled, 1);
}

void AwaitMark(pid_t tid) {
  for (int look = 0; look < 5000 && !IsMarkedForSignal(tid); ++look) usleep(1000);
}

// A thread whose call has been received may be on its way to sleep, which looks like a mark.
void AwaitSleep(pid_t tid) {
  for (int look = 0; look < 5000 && IsMarkedForSignal(tid); ++look) usleep(1000);
}

TEST(Trap, OnlyTheThreadThatTheKernelHasChosenForASignalIsMarked) {
  if (!TrapsHoldSignals()) GTEST_SKIP() << "takes Linux 5.19";
  HandleWith(0);
  g_handled = 0;
  TrappedThread thread([] { syscall(SYS_sched_yield); });
  if (!thread.is_trapped()) GTEST_SKIP() << "no trap here";
  const TrappedCall call = thread.Await(SYS_sched_yield);
  AwaitSleep(call.tid);
  EXPECT_FALSE(IsMarkedForSignal(call.tid));
  kill(getpid(), SIGUSR1);  // this thread handles it
  EXPECT_EQ(g_handled, 1);
  EXPECT_FALSE(IsMarkedForSignal(call.tid));
  pthread_kill(thread.id(), SIGUSR1);
  EXPECT_TRUE(IsMarkedForSignal(call.tid));
  usleep(20'000);
  EXPECT_TRUE(IsMarkedForSignal(call.tid));
  EXPECT_TRUE(AnswerTrapped(call.listener, call.id, 0));
}

TEST(Trap, TheKernelEndsTheCallOfAMarkedThreadAsItsHandlerHasIt) {
  if (!TrapsHoldSignals()) GTEST_SKIP() << "takes Linux 5.19";
  constexpr int kResult = 7;
  struct {
    int flags, answer;
    bool again;
  } const cases[] = {{0, by_signal::kAsFlagsSay, false},
                     {SA_RESTART, by_signal::kAsFlagsSay, true},
                     {0, by_signal::kAgain, true},
                     {SA_RESTART, by_signal::kAgainUnlessRun, false}};
  for (const auto& now : cases) {
    HandleWith(now.flags);
    std::atomic<long> result{0};
    std::atomic<int> error{0};
    {
      TrappedThread thread([&] {
        errno = 0;
        result = syscall(SYS_sched_yield);
        error = errno;
      });
      if (!thread.is_trapped()) GTEST_SKIP() << "no trap here";
      const TrappedCall call = thread.Await(SYS_sched_yield);
      pthread_kill(thread.id(), SIGUSR1);
      AwaitMark(call.tid);
      EXPECT_TRUE(EndsBySignal(-now.answer));
      EXPECT_TRUE(AnswerTrapped(call.listener, call.id, -now.answer));
      if (now.again) {
        const TrappedCall again = thread.Await(SYS_sched_yield);
        EXPECT_TRUE(again.IsAgain(call));
        EXPECT_TRUE(AnswerTrapped(again.listener, again.id, kResult));
      }
    }
    EXPECT_EQ(result, now.again ? kResult : -1) << now.flags << ", " << now.answer;
    EXPECT_EQ(error, now.again ? 0 : EINTR) << now.flags << ", " << now.answer;
  }
}

TEST(Trap, ACallIsAnsweredByAFileThatItsCallerThenHas) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const UniqueFd reads(ends[0]), writes(ends[1]);
  std::atomic<long> first{-1}, second{-1};
  {
    TrappedThread thread([&] {
      first = syscall(SYS_sched_yield);
      second = syscall(SYS_sched_yield);
    });
    if (!thread.is_trapped()) GTEST_SKIP() << "no trap here";
    const TrappedCall call = thread.Await(SYS_sched_yield);
    // The thread shares this process's table.
    const UniqueFd put(PutFileInto(call.listener, call.id, reads.get(), true));
    EXPECT_TRUE(put);
    EXPECT_EQ(fcntl(put.get(), F_GETFD), 0);
    EXPECT_TRUE(AnswerTrappedByFile(call.listener, call.id, reads.get(), false));
    const TrappedCall next = thread.Await(SYS_sched_yield);
    EXPECT_FALSE(AnswerTrappedByFile(next.listener, next.id + 1, reads.get(), false));
    EXPECT_TRUE(AnswerTrappedByFile(next.listener, next.id, -1, false)) << "by an error";
  }
  const UniqueFd copy(static_cast<int>(first.load()));
  ASSERT_GE(copy.get(), 0);
  EXPECT_EQ(fcntl(copy.get(), F_GETFD), FD_CLOEXEC);
  char c = 'x', got = 0;
  EXPECT_EQ(write(writes.get(), &c, 1), 1);
  EXPECT_EQ(read(copy.get(), &got, 1), 1);
  EXPECT_EQ(got, 'x');
  EXPECT_EQ(second, -1);
}

TEST(Trap, OtherErrorsAreNoEndsBySignals) {
  EXPECT_FALSE(EndsBySignal(0));
  EXPECT_FALSE(EndsBySignal(7));
  EXPECT_FALSE(EndsBySignal(-EINTR));
  EXPECT_FALSE(EndsBySignal(-EAGAIN));
  EXPECT_FALSE(EndsBySignal(INT64_MIN));
}

TEST(Trap, WithoutARealTimePriorityExecutionsAreHandedOverEvenTheShims) {
  std::atomic<int> error{0};
  {
    TrappedThread thread([&error] {
      syscall(SYS_execve, "/no/such/program", nullptr, nullptr, 0, 0, shm::kOwnCallMark);
      error = errno;
    });
    if (!thread.is_trapped()) GTEST_SKIP() << "no trap here";
    const TrappedCall call = thread.Await(SYS_execve);
    EXPECT_TRUE(IsExecution(call));
    EXPECT_TRUE(ContinueTrapped(call.listener, call.id));
  }
  EXPECT_EQ(error, ENOENT);
}

}  // namespace
}  // namespace tcs
