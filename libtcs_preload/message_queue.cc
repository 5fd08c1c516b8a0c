// POSIX message queues. Linux can poll them, so they are waited for like other descriptors; the
// kernel is only ever asked for what it can do at once.
#include <errno.h>
#include <mqueue.h>
#include <poll.h>

#include "libtcs_preload/call_file.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"
#include "libtcs_preload/receipts.h"
#include "libtcs_preload/signal_actions.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

// A deadline that has passed: the kernel then checks everything, but does not wait.
constexpr timespec kLongAgo{};

// 0, or an error.
int ToDeadline(const timespec* given, std::int64_t* deadline_ns) {
  *deadline_ns = tcs::shm::kNeverNs;
  if (given == nullptr) return 0;
  timespec timeout;
  if (!CopyIn(&timeout, given)) return EFAULT;
  if (ToNs(timeout) != tcs::shm::kNeverNs) {
    *deadline_ns = ToNs(timeout) - OffsetNs(Clock::kRealtime);
  }
  return IsValid(timeout) ? 0 : EINVAL;
}

// Makes `call(queue)` until the call does not have to wait any more. The call returns -ETIMEDOUT
// where it would wait.
template <class Call>
long WaitAndCall(GuestThread& t, mqd_t queue, short events, std::int64_t deadline_ns, Call call) {
  CallFile file(t, queue);
  for (;;) {
    const long result = call(file.fd());
    if (result != -ETIMEDOUT) return result;
    switch (file.Wait(events, deadline_ns, {})) {
      case WaitResult::kRetry:
        break;
      case WaitResult::kTimedOut:
        return call(file.fd());
      case WaitResult::kInterrupted:
        if (!RestartsAfterSignal()) return -EINTR;
        break;
    }
  }
}

long Receive(GuestThread& t, mqd_t queue, char* text, std::size_t size, unsigned* priority,
             const timespec* timeout) {
  std::int64_t deadline;
  if (const int error = ToDeadline(timeout, &deadline); error != 0) return -error;
  const auto call = [&](mqd_t from) {
    return RawSyscall(SYS_mq_timedreceive, from, Arg(text), static_cast<long>(size), Arg(priority),
                      Arg(&kLongAgo));
  };
  // A more urgent message than the one that is there may still be on its way.
  if (PollNow(queue, POLLIN)) HoldForRead(t);
  const long result = WaitAndCall(t, queue, POLLIN, deadline, call);
  if (result != -EAGAIN) return result;
  HoldForRead(t);
  return call(queue);
}

long Send(GuestThread& t, mqd_t queue, const char* text, std::size_t size, unsigned priority,
          const timespec* timeout) {
  std::int64_t deadline;
  if (const int error = ToDeadline(timeout, &deadline); error != 0) return -error;
  HoldForWrite(t);
  // The kernel may send a signal with the message: see kill.cc.
  const bool notifies = g_header->queues_notify.load(std::memory_order_relaxed) != 0;
  std::atomic<std::uint32_t>& signals = t.slot->signals;
  const long result = WaitAndCall(t, queue, POLLOUT, deadline, [&](mqd_t to) {
    if (notifies) signals.fetch_add(1, std::memory_order_relaxed);
    const long sent = RawSyscall(SYS_mq_timedsend, to, Arg(text), static_cast<long>(size),
                                 static_cast<long>(priority), Arg(&kLongAgo));
    if (sent != 0) signals.fetch_sub(1, std::memory_order_relaxed);
    return sent;
  });
  if (result == 0 && notifies) {
    Exchange(t, Request{.kind = tcs::shm::NotificationKind::kSignalled});
    signals.fetch_sub(1, std::memory_order_relaxed);
  }
  return result;
}

ssize_t TimedReceive(mqd_t queue, char* text, std::size_t size, unsigned* priority,
                     const timespec* timeout) {
  const Entered t;
  if (t == nullptr) {
    return ToErrno(RawSyscall(SYS_mq_timedreceive, queue, Arg(text), static_cast<long>(size),
                              Arg(priority), Arg(timeout)));
  }
  const long got = Receive(*t, queue, text, size, priority, timeout);
  if (got >= 0) NoteReceived(*t);
  return ToErrno(got);
}

int TimedSend(mqd_t queue, const char* text, std::size_t size, unsigned priority,
              const timespec* timeout) {
  const Entered t;
  if (t == nullptr) {
    return static_cast<int>(
        ToErrno(RawSyscall(SYS_mq_timedsend, queue, Arg(text), static_cast<long>(size),
                           static_cast<long>(priority), Arg(timeout))));
  }
  return static_cast<int>(ToErrno(Send(*t, queue, text, size, priority, timeout)));
}

}  // namespace

TCS_EXPORT ssize_t mq_timedreceive(mqd_t queue, char* __restrict text, std::size_t size,
                                   unsigned* __restrict priority,
                                   const timespec* __restrict timeout) {
  return TimedReceive(queue, text, size, priority, timeout);
}

TCS_EXPORT ssize_t mq_receive(mqd_t queue, char* text, std::size_t size, unsigned* priority) {
  return TimedReceive(queue, text, size, priority, nullptr);
}

TCS_EXPORT int mq_timedsend(mqd_t queue, const char* text, std::size_t size, unsigned priority,
                            const timespec* timeout) {
  return TimedSend(queue, text, size, priority, timeout);
}

TCS_EXPORT int mq_send(mqd_t queue, const char* text, std::size_t size, unsigned priority) {
  return TimedSend(queue, text, size, priority, nullptr);
}

TCS_EXPORT int mq_notify(mqd_t queue, const sigevent* notification) noexcept {
  const Entered t;
  // From now on senders tell the coordinator when they have sent something.
  if (t != nullptr && notification != nullptr) {
    Exchange(*t, Request{.kind = tcs::shm::NotificationKind::kQueueNotifies});
  }
  return TCS_REAL(mq_notify)(queue, notification);
}
