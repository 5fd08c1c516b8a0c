// Semaphores, message queues and sigtimedwait by raw system calls: they wait in virtual time, to
// virtual deadlines, and for other threads' calls, made raw or by the library.
#include <fcntl.h>
#include <mqueue.h>
#include <signal.h>
#include <sys/ipc.h>
#include <sys/msg.h>
#include <sys/sem.h>
#include <sys/syscall.h>

#include "tests/conformance/child_later.h"

using namespace conformance;

namespace {

constexpr std::int64_t kTimeout = 70 * kMs;

struct Message {
  long type;
  char text[64];
};

long Operate(int id, short change, const timespec* timeout, short flags = 0) {
  sembuf operation{0, change, flags};
  return syscall(SYS_semtimedop, id, &operation, 1, timeout);
}

void ExpectTook(std::int64_t start, std::int64_t wanted, const char* what) {
  ExpectSoonAfter(start, wanted, what, 5 * kMs);
}

void Semaphores() {
  const int id = semget(IPC_PRIVATE, 1, 0600);
  EXPECT(id >= 0, "%s", strerror(errno));
  const timespec timeout = ToTimespec(kTimeout), none{}, bad{0, kSecond};
  const timespec far = ToTimespec(60 * kSecond);  // natively a busy machine may be late
  std::int64_t start = Now();
  EXPECT(Operate(id, -1, &timeout) == -1 && errno == EAGAIN, "%s", strerror(errno));
  ExpectTook(start, kTimeout, "semtimedop");
  start = Now();
  EXPECT(Operate(id, -1, &none) == -1 && errno == EAGAIN, "%s", strerror(errno));
  EXPECT(Operate(id, -1, &far, IPC_NOWAIT) == -1 && errno == EAGAIN, "%s", strerror(errno));
  EXPECT(Operate(id, -1, &bad) == -1 && errno == EINVAL, "%s", strerror(errno));
  ExpectTook(start, 0, "what does not wait");
  const auto library_gives = [id] {
    sembuf give{0, 1, 0};
    EXPECT(semop(id, &give, 1) == 0, "%s", strerror(errno));
  };
  const auto call_gives = [id] { EXPECT(Operate(id, 1, nullptr) == 0, "%s", strerror(errno)); };
  WakesAfterTheDelay("one without a deadline", library_gives,
                     [&] { EXPECT(Operate(id, -1, nullptr) == 0, "%s", strerror(errno)); });
  WakesAfterTheDelay("one with a deadline", library_gives,
                     [&] { EXPECT(Operate(id, -1, &far) == 0, "%s", strerror(errno)); });
  WakesAfterTheDelay("the library's", call_gives, [&] {
    sembuf take{0, -1, 0};
    EXPECT(semop(id, &take, 1) == 0, "%s", strerror(errno));
  });
  WakesAfterTheDelay("the library's with a deadline", call_gives, [&] {
    sembuf take{0, -1, 0};
    EXPECT(semtimedop(id, &take, 1, &far) == 0, "%s", strerror(errno));
  });
  WakesAfterTheDelay(
      "one with a deadline whose semaphore is set",
      [id] { EXPECT(syscall(SYS_semctl, id, 0, SETVAL, 1) == 0, "%s", strerror(errno)); },
      [&] { EXPECT(Operate(id, -1, &far) == 0, "%s", strerror(errno)); });
  WakesAfterTheDelay(
      "one with a deadline whose semaphore is removed",
      [id] { EXPECT(syscall(SYS_semctl, id, 0, IPC_RMID, 0) == 0, "%s", strerror(errno)); },
      [&] { EXPECT(Operate(id, -1, &far) == -1 && errno == EIDRM, "%s", strerror(errno)); });
}

void MessagesOfSystemV() {
  const int id = msgget(IPC_PRIVATE, 0600);
  EXPECT(id >= 0, "%s", strerror(errno));
  WakesAfterTheDelay(
      "msgrcv",
      [id] {
        const Message sent{3, "hello"};
        EXPECT(syscall(SYS_msgsnd, id, &sent, sizeof sent.text, 0) == 0, "%s", strerror(errno));
      },
      [id] {
        Message got{};
        const long size = syscall(SYS_msgrcv, id, &got, sizeof got.text, 3, 0);
        EXPECT(size == sizeof got.text && strcmp(got.text, "hello") == 0, "%ld", size);
      });
  EXPECT(syscall(SYS_msgctl, id, IPC_RMID, nullptr) == 0, "%s", strerror(errno));
}

void PosixQueues() {
  mq_attr attributes{};
  attributes.mq_maxmsg = 1;
  attributes.mq_msgsize = 64;
  char name[32];
  snprintf(name, sizeof name, "/tcs_raw_%d", getpid());
  const mqd_t queue = mq_open(name, O_RDWR | O_CREAT | O_EXCL, 0600, &attributes);
  EXPECT(queue >= 0, "%s", strerror(errno));
  mq_unlink(name);
  char text[64] = "";
  const auto receive = [&](const timespec* until) {
    return syscall(SYS_mq_timedreceive, queue, text, sizeof text, nullptr, until);
  };
  std::int64_t start = Now();
  timespec until = ToTimespec(Now(CLOCK_REALTIME) + kTimeout);
  EXPECT(receive(&until) == -1 && errno == ETIMEDOUT, "%s", strerror(errno));
  ExpectTook(start, kTimeout, "mq_timedreceive");
  start = Now();
  const timespec past = ToTimespec(Now(CLOCK_REALTIME) - kSecond), bad{0, 2 * kSecond};
  EXPECT(receive(&past) == -1 && errno == ETIMEDOUT, "%s", strerror(errno));
  EXPECT(receive(&bad) == -1 && errno == EINVAL, "%s", strerror(errno));
  EXPECT(syscall(SYS_mq_timedreceive, queue, text, 1, nullptr, nullptr) == -1 && errno == EMSGSIZE,
         "%s", strerror(errno));
  ExpectTook(start, 0, "what does not wait");
  until = ToTimespec(Now(CLOCK_REALTIME) + 60 * kSecond);
  WakesAfterTheDelay(
      "mq_timedreceive",
      [&] { EXPECT(syscall(SYS_mq_timedsend, queue, "now", 4, 0, nullptr) == 0, "send"); },
      [&] { EXPECT(receive(&until) == 4 && strcmp(text, "now") == 0, "%s", strerror(errno)); });
  EXPECT(syscall(SYS_mq_timedsend, queue, "full", 5, 0, nullptr) == 0, "%s", strerror(errno));
  start = Now();
  until = ToTimespec(Now(CLOCK_REALTIME) + kTimeout);
  EXPECT(syscall(SYS_mq_timedsend, queue, "more", 5, 0, &until) == -1 && errno == ETIMEDOUT, "%s",
         strerror(errno));
  ExpectTook(start, kTimeout, "mq_timedsend");
  mq_close(queue);
}

volatile sig_atomic_t g_handled = 0;
void Handle(int) { g_handled = g_handled + 1; }

void Signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGUSR1);
  sigprocmask(SIG_BLOCK, &set, nullptr);
  const timespec timeout = ToTimespec(kTimeout), far = ToTimespec(60 * kSecond);
  siginfo_t info{};
  const auto accept = [&](const timespec* given) {
    return syscall(SYS_rt_sigtimedwait, &set, &info, given, 8);
  };
  std::int64_t start = Now();
  EXPECT(accept(&timeout) == -1 && errno == EAGAIN, "%s", strerror(errno));
  ExpectTook(start, kTimeout, "rt_sigtimedwait");
  const pid_t self = getpid();
  WakesAfterTheDelay(
      "rt_sigtimedwait", [self] { kill(self, SIGUSR1); },
      [&] { EXPECT(accept(&far) == SIGUSR1 && info.si_code == SI_USER, "%s", strerror(errno)); });
  WakesAfterTheDelay(
      "rt_sigtimedwait without a timeout", [self] { kill(self, SIGUSR1); },
      [&] { EXPECT(accept(nullptr) == SIGUSR1, "%s", strerror(errno)); });
  raise(SIGUSR1);
  start = Now();
  const timespec none{};
  EXPECT(accept(&none) == SIGUSR1, "%s", strerror(errno));
  EXPECT(accept(&none) == -1 && errno == EAGAIN, "%s", strerror(errno));
  ExpectTook(start, 0, "what does not wait");
  struct sigaction action {};
  action.sa_handler = Handle;
  action.sa_flags = SA_RESTART;
  sigaction(SIGUSR2, &action, nullptr);
  WakesAfterTheDelay(
      "another signal", [self] { kill(self, SIGUSR2); },
      [&] { EXPECT(accept(&far) == -1 && errno == EINTR, "%s", strerror(errno)); });
  EXPECT(g_handled == 1, "%d handled", int(g_handled));
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Semaphores();
  MessagesOfSystemV();
  PosixQueues();
  Signals();
}
