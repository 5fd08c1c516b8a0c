// System V semaphores and message queues. The kernel is asked for what it can do at once; where it
// can do nothing at once the kernel holds the thread, counts it among the waiting threads, keeps
// their order, and gives a thread what it waits for in the very call of another thread that makes
// it possible. Only waits with a deadline are not the kernel's, whose time is the host's: there the
// thread waits until another thread has changed the object. A thread that changes an object tells
// the coordinator, if anybody waits.
#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ipc.h>
#include <sys/msg.h>
#include <sys/sem.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/ipc_times.h"
#include "libtcs_preload/kernel_objects.h"
#include "libtcs_preload/kernel_wait.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/receipts.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;
using tcs::shm::IpcEvent;
using tcs::shm::IpcKind;
using tcs::shm::KernelObjectKind;
using tcs::shm::NotificationKind;
using tcs::shm::WakeReason;

namespace {

constexpr int kWouldWait = 4096;              // no errno
constexpr std::size_t kMostOperations = 500;  // the kernel's SEMOPM; above it says E2BIG

// Threads that the kernel holds may wait for the object, and threads that wait here.
void TellOfChange(GuestThread& t, KernelObjectKind kind, int id) {
  TellKernelWaiters(t);
  TellChanged(t, kind, id);
}

// Makes `at_once`, which returns -`blocks` where it would have to wait, and then `waiting`, the
// same call in the form that waits. The reads and changes of the call have a place in time, so
// nothing from before may be missing.
template <class AtOnce, class Waiting>
long CallInKernel(GuestThread& t, KernelObjectKind kind, int id, int blocks, bool cancellable,
                  AtOnce at_once, Waiting waiting) {
  HoldForRead(t);
  long result = at_once();
  if (result == -blocks && !IsShutDown()) result = WaitInKernel(t, cancellable, waiting);
  if (result >= 0) TellOfChange(t, kind, id);
  return result == -blocks ? -EINTR : result;
}

// Makes `call`, which returns -`blocks` where it would have to wait, until it need not, or until
// the deadline.
template <class Call>
long CallUntil(GuestThread& t, KernelObjectKind kind, int id, int blocks, std::int64_t deadline_ns,
               Call call) {
  HoldForRead(t);
  for (bool again = false;; again = true) {
    const long result = call();
    if (result >= 0) TellOfChange(t, kind, id);
    if (again && result == -EINVAL) return -EIDRM;
    if (result != -blocks) return result;
    if (IsShutDown()) return -EINTR;
    const Reply reply =
        Exchange(t, Request{.kind = NotificationKind::kWaitObject,
                            .deadline_ns = deadline_ns,
                            .args = {static_cast<std::int64_t>(kind), id, again ? 1 : 0},
                            .interruptible = true});
    // The calls here are not made again after a handler, whatever the handler was installed with.
    if (reply.reason == WakeReason::kSignal) return -EINTR;
    if (reply.reason == WakeReason::kDeadline) {
      const long last = call();
      if (last >= 0) TellOfChange(t, kind, id);
      return last;
    }
  }
}

// True if the first of the operations that has to wait is one that must not.
bool MustNotWait(int id, const sembuf* operations, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    long value = RawSyscall(SYS_semctl, id, operations[i].sem_num, GETVAL);
    for (std::size_t j = 0; j < i; ++j) {
      if (operations[j].sem_num == operations[i].sem_num) value += operations[j].sem_op;
    }
    const long change = operations[i].sem_op;
    if (change == 0 ? value != 0 : value + change < 0) {
      return (operations[i].sem_flg & IPC_NOWAIT) != 0;
    }
  }
  return false;
}

long Operate(GuestThread& t, int id, sembuf* operations, std::size_t count, const timespec* given) {
  timespec timeout{};
  if (given != nullptr && !CopyIn(&timeout, given)) return -EFAULT;
  if (count > kMostOperations) return -E2BIG;
  if (!CanRead(operations, count * sizeof *operations)) return -EFAULT;
  if (!IsValid(timeout)) return -EINVAL;
  auto* const at_once = static_cast<sembuf*>(__builtin_alloca(count * sizeof(sembuf)));
  bool some = false;  // must not wait
  for (std::size_t i = 0; i < count; ++i) {
    at_once[i] = operations[i];
    some |= (operations[i].sem_flg & IPC_NOWAIT) != 0;
    at_once[i].sem_flg = static_cast<short>(operations[i].sem_flg | IPC_NOWAIT);
  }
  const auto noted = [&](long done) {
    if (done >= 0) NoteIpc(t, IpcKind::kSemaphores, id, IpcEvent::kPut);
    return done;
  };
  const auto probe = [&]() -> long {
    const long done = noted(RawSyscall(SYS_semop, id, Arg(at_once), static_cast<long>(count)));
    return done == -EAGAIN && !(some && MustNotWait(id, operations, count)) ? -kWouldWait : done;
  };
  if (given == nullptr) {
    return CallInKernel(t, KernelObjectKind::kSemaphores, id, kWouldWait, false, probe, [&] {
      return noted(RawSyscall(SYS_semop, id, Arg(operations), static_cast<long>(count)));
    });
  }
  const long result = CallUntil(t, KernelObjectKind::kSemaphores, id, kWouldWait,
                                DeadlineAfter(t, ToNs(timeout)), probe);
  return result == -kWouldWait ? -EAGAIN : result;
}

int SemaphoreOperation(int id, sembuf* operations, std::size_t count, const timespec* timeout) {
  const Entered t;
  if (t == nullptr) {
    return static_cast<int>(ToErrno(
        RawSyscall(SYS_semtimedop, id, Arg(operations), static_cast<long>(count), Arg(timeout))));
  }
  return static_cast<int>(ToErrno(Operate(*t, id, operations, count, timeout)));
}

}  // namespace

TCS_EXPORT int semop(int id, sembuf* operations, std::size_t count) noexcept {
  return SemaphoreOperation(id, operations, count, nullptr);
}

TCS_EXPORT int semtimedop(int id, sembuf* operations, std::size_t count,
                          const timespec* timeout) noexcept {
  return SemaphoreOperation(id, operations, count, timeout);
}

TCS_EXPORT int semctl(int id, int number, int command, ...) noexcept {
  va_list arguments;
  va_start(arguments, command);
  const long argument = va_arg(arguments, long);  // a union of an int and pointers
  va_end(arguments);
  const Entered t;
  if (t != nullptr) HoldForRead(*t);
  const long result = RawSyscall(SYS_semctl, id, number, command, argument);
  if (t == nullptr || result < 0) return static_cast<int>(ToErrno(result));
  auto* status = reinterpret_cast<semid_ds*>(argument);
  switch (command) {
    case IPC_STAT:
      ShowIpcTimes(*t, id, status);
      break;
    case SEM_STAT:
    case SEM_STAT_ANY:
      ShowIpcTimes(*t, static_cast<int>(result), status);
      break;
    case IPC_SET:
      NoteIpc(*t, IpcKind::kSemaphores, id, IpcEvent::kChanged);
      break;
    case SETVAL:
    case SETALL:
      NoteIpc(*t, IpcKind::kSemaphores, id, IpcEvent::kChanged);
      TellOfChange(*t, KernelObjectKind::kSemaphores, id);
      break;
    case IPC_RMID:
      ForgetIpc(*t, IpcKind::kSemaphores, id);
      TellOfChange(*t, KernelObjectKind::kSemaphores, id);
      break;
    default:
      break;
  }
  return static_cast<int>(ToErrno(result));
}

TCS_EXPORT int msgsnd(int id, const void* message, std::size_t size, int flags) {
  const Entered t;
  auto call = [&](int with) {
    return RawSyscall(SYS_msgsnd, id, Arg(message), static_cast<long>(size), with);
  };
  if (t == nullptr) return static_cast<int>(ToErrno(call(flags)));
  const int blocks = (flags & IPC_NOWAIT) != 0 ? kWouldWait : EAGAIN;
  const auto send = [&](int with) {
    const long sent = call(with);
    if (sent >= 0) NoteIpc(*t, IpcKind::kMessages, id, IpcEvent::kPut);
    if (sent >= 0) NoteSent(*t);
    return sent;
  };
  return static_cast<int>(ToErrno(CallInKernel(
      *t, KernelObjectKind::kMessages, id, blocks, true, [&] { return send(flags | IPC_NOWAIT); },
      [&] { return send(flags); })));
}

TCS_EXPORT ssize_t msgrcv(int id, void* message, std::size_t size, long type, int flags) {
  const Entered t;
  auto call = [&](int with) {
    return RawSyscall(SYS_msgrcv, id, Arg(message), static_cast<long>(size), type, with);
  };
  if (t == nullptr) return ToErrno(call(flags));
  const int blocks = (flags & IPC_NOWAIT) != 0 ? kWouldWait : ENOMSG;
  const auto receive = [&](int with) {
    const long got = call(with);
    // A copy leaves the queue as it is.
    if (got >= 0 && (flags & MSG_COPY) == 0) {
      NoteIpc(*t, IpcKind::kMessages, id, IpcEvent::kTaken);
      NoteReceived(*t);
    }
    return got;
  };
  return ToErrno(CallInKernel(
      *t, KernelObjectKind::kMessages, id, blocks, true,
      [&] { return receive(flags | IPC_NOWAIT); }, [&] { return receive(flags); }));
}

TCS_EXPORT int msgctl(int id, int command, msqid_ds* buffer) noexcept {
  const Entered t;
  if (t != nullptr) HoldForRead(*t);
  const long result = RawSyscall(SYS_msgctl, id, command, Arg(buffer));
  if (t == nullptr || result < 0) return static_cast<int>(ToErrno(result));
  if (command == IPC_STAT) ShowIpcTimes(*t, id, buffer);
  if (command == MSG_STAT || command == MSG_STAT_ANY) {
    ShowIpcTimes(*t, static_cast<int>(result), buffer);
  }
  if (command == IPC_SET) NoteIpc(*t, IpcKind::kMessages, id, IpcEvent::kChanged);
  if (command == IPC_RMID) ForgetIpc(*t, IpcKind::kMessages, id);
  if (command == IPC_RMID || command == IPC_SET) TellOfChange(*t, KernelObjectKind::kMessages, id);
  return static_cast<int>(ToErrno(result));
}
