// POSIX message queues: waiting for room and for messages, deadlines, priorities, notification.
#include <fcntl.h>
#include <mqueue.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>

#include "tests/conformance/child_later.h"

using namespace conformance;

namespace {

constexpr std::int64_t kChildDelay = 30 * kMs;
char g_name[64];

mqd_t OpenQueue(int flags) {
  mq_attr attributes{};
  attributes.mq_maxmsg = 2;
  attributes.mq_msgsize = 8;
  const mqd_t queue = mq_open(g_name, O_CREAT | flags, 0600, &attributes);
  EXPECT(queue >= 0, "mq_open: %s", strerror(errno));
  return queue;
}

ssize_t Receive(mqd_t queue, unsigned* priority = nullptr) {
  char text[8];
  return mq_receive(queue, text, sizeof text, priority);
}

ssize_t ReceiveUntil(mqd_t queue, std::int64_t deadline) {
  char text[8];
  const timespec until = ToTimespec(deadline);
  return mq_timedreceive(queue, text, sizeof text, nullptr, &until);
}

int SendUntil(mqd_t queue, std::int64_t deadline) {
  const timespec until = ToTimespec(deadline);
  return mq_timedsend(queue, "x", 1, 0, &until);
}

void Deadlines(mqd_t queue) {
  std::int64_t start = Now();
  std::int64_t deadline = Now(CLOCK_REALTIME) + kChildDelay;
  EXPECT(ReceiveUntil(queue, deadline) == -1 && errno == ETIMEDOUT, "receive: %s", strerror(errno));
  ExpectWaited(start, kChildDelay, 2, "a receive's deadline");
  start = Now();
  EXPECT(ReceiveUntil(queue, deadline) == -1 && errno == ETIMEDOUT, "receive: %s", strerror(errno));
  ExpectWaited(start, 0, 2, "a deadline that has passed");

  EXPECT(SendUntil(queue, deadline) == 0 && SendUntil(queue, 0) == 0, "there is room");
  start = Now();
  deadline = Now(CLOCK_REALTIME) + kChildDelay;
  EXPECT(SendUntil(queue, deadline) == -1 && errno == ETIMEDOUT, "send: %s", strerror(errno));
  ExpectWaited(start, kChildDelay, 2, "a send's deadline");
  EXPECT(ReceiveUntil(queue, 0) == 1 && Receive(queue) == 1, "what is there is received");
}

void Errors(mqd_t queue) {
  const mqd_t reader = OpenQueue(O_RDONLY), writer = OpenQueue(O_WRONLY);
  const mqd_t impatient = OpenQueue(O_RDWR | O_NONBLOCK);
  char text[8];
  const timespec bad{0, kSecond};
  EXPECT(Receive(writer) == -1 && errno == EBADF, "%s", strerror(errno));
  EXPECT(mq_send(reader, "x", 1, 0) == -1 && errno == EBADF, "%s", strerror(errno));
  EXPECT(mq_receive(queue, text, 7, nullptr) == -1 && errno == EMSGSIZE, "%s", strerror(errno));
  EXPECT(mq_send(queue, "123456789", 9, 0) == -1 && errno == EMSGSIZE, "%s", strerror(errno));
  EXPECT(mq_send(queue, "x", 1, 1u << 20) == -1 && errno == EINVAL, "%s", strerror(errno));
  EXPECT(mq_timedreceive(queue, text, 8, nullptr, &bad) == -1 && errno == EINVAL, "%s",
         strerror(errno));
  EXPECT(Receive(impatient) == -1 && errno == EAGAIN, "%s", strerror(errno));
  EXPECT(mq_send(impatient, "x", 1, 0) == 0 && mq_send(impatient, "x", 1, 0) == 0, "send");
  EXPECT(mq_send(impatient, "x", 1, 0) == -1 && errno == EAGAIN, "%s", strerror(errno));
  EXPECT(Receive(impatient) == 1 && Receive(impatient) == 1, "receive");
  for (const mqd_t q : {reader, writer, impatient}) mq_close(q);
  EXPECT(Receive(-1) == -1 && errno == EBADF, "%s", strerror(errno));
}

void Waits(mqd_t queue) {
  auto send = [queue] { EXPECT(mq_send(queue, "x", 1, 0) == 0, "send: %s", strerror(errno)); };
  auto receive = [queue] { EXPECT(Receive(queue) == 1, "receive: %s", strerror(errno)); };
  WakesAfterTheDelay("a receiver", send, receive);
  WakesAfterTheDelay("a receiver with a deadline", send, [queue] {
    EXPECT(ReceiveUntil(queue, Now(CLOCK_REALTIME) + kSecond) == 1, "%s", strerror(errno));
  });
  WakesAfterTheDelay("poll", send, [queue] {
    pollfd fd{queue, POLLIN, 0};
    EXPECT(poll(&fd, 1, -1) == 1, "poll: %s", strerror(errno));
  });
  send();  // now it is full
  WakesAfterTheDelay("a sender", receive, send);
  WakesAfterTheDelay("a sender with a deadline", receive, [queue] {
    EXPECT(SendUntil(queue, Now(CLOCK_REALTIME) + kSecond) == 0, "%s", strerror(errno));
  });
  receive();
  receive();
}

void Priorities(mqd_t queue) {
  unsigned priority = 0;
  EXPECT(mq_send(queue, "low", 3, 1) == 0 && mq_send(queue, "high", 4, 9) == 0, "send");
  EXPECT(Receive(queue, &priority) == 4 && priority == 9, "priority %u came first", priority);
  EXPECT(Receive(queue, &priority) == 3 && priority == 1, "priority %u came second", priority);
}

std::int64_t g_notified_ns = 0;
void Notified(int, siginfo_t* info, void*) {
  if (info->si_code == SI_MESGQ && info->si_value.sival_int == 7) g_notified_ns = Now();
}

void Notification(mqd_t queue) {
  struct sigaction action {};
  action.sa_sigaction = Notified;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGUSR1, &action, nullptr);
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGUSR1;
  event.sigev_value.sival_int = 7;
  EXPECT(mq_notify(queue, &event) == 0, "mq_notify: %s", strerror(errno));
  EXPECT(mq_notify(queue, &event) == -1 && errno == EBUSY, "a second notification");
  const std::int64_t start = Now();
  WakesAfterTheDelay(
      "a notified process",
      [queue] { EXPECT(mq_send(queue, "x", 1, 0) == 0, "send: %s", strerror(errno)); },
      [] { EXPECT(pause() == -1 && errno == EINTR, "pause"); });
  EXPECT(g_notified_ns - start >= conformance::kChildDelay, "notified after %lld ns",
         (long long)(g_notified_ns - start));
  if (g_mode != Mode::kNative) {
    EXPECT(g_notified_ns - start < conformance::kChildDelay + MostOfChildren(),
           "notified after %lld ns", (long long)(g_notified_ns - start));
  }
  EXPECT(Receive(queue) == 1, "receive: %s", strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  snprintf(g_name, sizeof g_name, "/conformance.%d", getpid());
  const mqd_t queue = OpenQueue(O_RDWR);
  Deadlines(queue);
  Errors(queue);
  Waits(queue);
  Priorities(queue);
  Notification(queue);
  EXPECT(mq_unlink(g_name) == 0, "mq_unlink: %s", strerror(errno));
}
