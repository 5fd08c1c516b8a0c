// System V semaphores and message queues: waiting, deadlines, removal, undoing.
#include <signal.h>
#include <sys/ipc.h>
#include <sys/msg.h>
#include <sys/sem.h>
#include <sys/wait.h>

#include "tests/conformance/child_later.h"
#include "tests/conformance/natively_until.h"

using namespace conformance;

namespace {

constexpr std::int64_t kChildDelay = 30 * kMs;

struct Message {
  long type;
  char text[4096];
};

int Operate(int id, int number, int change, int flags = 0) {
  sembuf operation{static_cast<unsigned short>(number), static_cast<short>(change),
                   static_cast<short>(flags)};
  return semop(id, &operation, 1);
}

void Must(int result) { EXPECT(result == 0, "%s", strerror(errno)); }

void SemaphoreDeadlines(int id) {
  sembuf take{0, -1, 0};
  const timespec timeout = ToTimespec(kChildDelay), none{}, bad{0, kSecond};
  std::int64_t start = Now();
  EXPECT(semtimedop(id, &take, 1, &timeout) == -1 && errno == EAGAIN, "%s", strerror(errno));
  ExpectWaited(start, kChildDelay, 2, "semtimedop");
  start = Now();
  EXPECT(semtimedop(id, &take, 1, &none) == -1 && errno == EAGAIN, "%s", strerror(errno));
  EXPECT(Operate(id, 0, -1, IPC_NOWAIT) == -1 && errno == EAGAIN, "%s", strerror(errno));
  // The first that has to wait decides.
  sembuf both[2] = {{1, -1, IPC_NOWAIT}, {0, -1, 0}};
  EXPECT(semop(id, both, 2) == -1 && errno == EAGAIN, "%s", strerror(errno));
  ExpectWaited(start, 0, 4, "what does not wait");
  EXPECT(semtimedop(id, &take, 1, &bad) == -1 && errno == EINVAL, "%s", strerror(errno));
  EXPECT(Operate(id, 9, 1) == -1 && errno == EFBIG, "%s", strerror(errno));
  EXPECT(Operate(-1, 0, 1) == -1 && errno == EINVAL, "%s", strerror(errno));
}

void SemaphoreWaits(int id) {
  WakesAfterTheDelay(
      "a taker", [=] { Must(Operate(id, 0, 1)); }, [=] { Must(Operate(id, 0, -1)); });
  WakesAfterTheDelay(
      "one who takes two",
      [=] {
        Must(Operate(id, 0, 1));  // which is not enough
        Must(Operate(id, 0, 1));
      },
      [=] { Must(Operate(id, 0, -2)); });
  Must(Operate(id, 0, 3));
  WakesAfterTheDelay(
      "one who waits for none", [=] { Must(Operate(id, 0, -3)); },
      [=] { Must(Operate(id, 0, 0)); });
  WakesAfterTheDelay(
      "one who waits for a setting", [=] { Must(semctl(id, 0, SETVAL, 1)); },
      [=] { Must(Operate(id, 0, -1)); });
  // What a process took is given back when it ends.
  Must(Operate(id, 1, 1));
  const std::int64_t start = Now();
  const pid_t holder = fork();
  if (holder == 0) {
    Must(Operate(id, 1, -1, SEM_UNDO));
    usleep(2 * kChildDelay / 1000);
    _exit(0);
  }
  while (semctl(id, 1, GETVAL) != 0) usleep(1000);  // until the child has it
  Must(Operate(id, 1, -1));
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= 2 * kChildDelay, "undone after %lld ns", (long long)passed);
  if (g_mode != Mode::kNative)
    EXPECT(passed < 2 * kChildDelay + MostOfChildren(), "%lld ns", (long long)passed);
  EXPECT(waitpid(holder, nullptr, 0) == holder, "waitpid");
}

// Three that wait for one semaphore get it in the order in which they came.
void SemaphoreOrder(int id) {
  int order[2];
  EXPECT(pipe(order) == 0, "pipe");
  pid_t children[3];
  for (int i = 0; i < 3; ++i) {
    children[i] = fork();
    if (children[i] == 0) {
      while (semctl(id, 0, GETNCNT) != i) usleep(1000);
      Must(Operate(id, 0, -1));
      _exit(write(order[1], &i, sizeof i) == sizeof i ? 0 : 1);
    }
  }
  while (semctl(id, 0, GETNCNT) != 3) usleep(1000);
  for (int i = 0; i < 3; ++i) {
    Must(Operate(id, 0, 1));
    int came = -1;
    EXPECT(read(order[0], &came, sizeof came) == sizeof came && came == i, "%d came, not %d", came,
           i);
  }
  for (const pid_t child : children) waitpid(child, nullptr, 0);
}

// Who unlocks and locks again at once finds the lock given to the one who has waited for it.
void HandsOver(int id) {
  Must(semctl(id, 0, SETVAL, 1));
  Must(Operate(id, 0, -1));
  const pid_t waiter = fork();
  if (waiter == 0) {
    Must(Operate(id, 0, -1));
    Must(Operate(id, 1, 1));  // says so
    Must(Operate(id, 0, 1));
    _exit(0);
  }
  // Counted by the kernel, which natively is how to know that it waits.
  while (semctl(id, 0, GETNCNT) != 1) usleep(1000);
  int turns = 0;
  while (semctl(id, 1, GETVAL) == 0) {
    Must(Operate(id, 0, 1));
    Must(Operate(id, 0, -1));
    EXPECT(++turns < 3, "it waits after %d turns of another's", turns);
  }
  Must(Operate(id, 0, 1));
  Must(Operate(id, 1, -1));
  EXPECT(waitpid(waiter, nullptr, 0) == waiter, "waitpid");
  Must(semctl(id, 0, SETVAL, 0));
}

void Messages(int id) {
  Message message{1, "hello"};
  EXPECT(msgrcv(id, &message, 8, 0, IPC_NOWAIT) == -1 && errno == ENOMSG, "%s", strerror(errno));
  WakesAfterTheDelay(
      "a receiver",
      [=] {
        Message other{5, "other"}, wanted{7, "wanted"};
        Must(msgsnd(id, &other, 8, 0));  // not for it
        usleep(1000);
        Must(msgsnd(id, &wanted, 8, 0));
      },
      [&] {
        EXPECT(msgrcv(id, &message, 8, 7, 0) == 8 && strcmp(message.text, "wanted") == 0, "%s",
               strerror(errno));
      });
  EXPECT(msgrcv(id, &message, 4, 5, 0) == -1 && errno == E2BIG, "%s", strerror(errno));
  EXPECT(msgrcv(id, &message, 4, 5, MSG_NOERROR) == 4, "%s", strerror(errno));

  // Full, it makes senders wait.
  int count = 0;
  message.type = 1;
  while (msgsnd(id, &message, sizeof message.text, IPC_NOWAIT) == 0) ++count;
  EXPECT(errno == EAGAIN && count > 0, "%s", strerror(errno));
  WakesAfterTheDelay(
      "a sender",
      [=] {
        Message taken;
        EXPECT(msgrcv(id, &taken, sizeof taken.text, 0, 0) == sizeof taken.text, "msgrcv");
      },
      [&] { Must(msgsnd(id, &message, sizeof message.text, 0)); });
  while (msgrcv(id, &message, sizeof message.text, 0, IPC_NOWAIT) >= 0) {
  }
}

volatile sig_atomic_t g_alarms = 0;
void CountAlarm(int) { g_alarms = g_alarms + 1; }

// A SIGALRM for a caller that will wait. Natively from a child, which sees whether it does.
void AlarmTheWaiter() {
  if (g_mode != Mode::kNative) {
    ualarm(kChildDelay / 1000, 0);
    return;
  }
  if (fork() != 0) return;
  usleep(kChildDelay / 1000);
  NativelyUntil([] { return Sleeps(getppid()); });
  kill(getppid(), SIGALRM);
  _exit(0);
}

// A handler ends the wait, even one that wants calls to be made again.
void Interruptions(int semaphores, int messages) {
  struct sigaction action {};
  action.sa_handler = CountAlarm;
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, nullptr);
  for (const bool receives : {false, true}) {
    const std::int64_t start = Now();
    AlarmTheWaiter();
    Message message;
    const long result = receives ? msgrcv(messages, &message, 8, 0, 0) : Operate(semaphores, 0, -1);
    EXPECT(result == -1 && errno == EINTR, "%ld: %s", result, strerror(errno));
    ExpectWaited(start + (g_mode == Mode::kFixed ? kCallNs : 0), kChildDelay, 1,
                 "an interrupted wait");
    if (g_mode == Mode::kNative) EXPECT(wait(nullptr) > 0, "%s", strerror(errno));
  }
  EXPECT(g_alarms == 2, "%d alarms", int(g_alarms));
}

void Removal(int semaphores, int messages) {
  WakesAfterTheDelay(
      "a waiter for removed semaphores", [=] { Must(semctl(semaphores, 0, IPC_RMID)); },
      [=] {
        EXPECT(Operate(semaphores, 0, -1) == -1 && errno == EIDRM, "semop: %s", strerror(errno));
      });
  WakesAfterTheDelay(
      "a waiter for a removed queue", [=] { Must(msgctl(messages, IPC_RMID, nullptr)); },
      [=] {
        Message message;
        EXPECT(msgrcv(messages, &message, 8, 0, 0) == -1 && errno == EIDRM, "msgrcv: %s",
               strerror(errno));
      });
  EXPECT(Operate(semaphores, 0, 1) == -1 && errno == EINVAL, "%s", strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  const int semaphores = semget(IPC_PRIVATE, 2, 0600), messages = msgget(IPC_PRIVATE, 0600);
  EXPECT(semaphores >= 0 && messages >= 0, "%s", strerror(errno));
  SemaphoreDeadlines(semaphores);
  SemaphoreWaits(semaphores);
  SemaphoreOrder(semaphores);
  HandsOver(semaphores);
  Messages(messages);
  Interruptions(semaphores, messages);
  Removal(semaphores, messages);
}
