#include "coordinator/calls/syscall_ipc.h"

#include <errno.h>
#include <mqueue.h>
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <time.h>

#include <algorithm>
#include <utility>

#include "coordinator/calls/syscall_semaphores.h"
#include "coordinator/os/signal_bits.h"
#include "coordinator/tasks/client_values.h"
#include "coordinator/tasks/remote_descriptor.h"
#include "coordinator/tasks/signal_sets.h"

namespace tcs {

namespace {

// Whether the kernel refuses the call before it waits.
bool IsRefused(const RemoteDescriptor& queue, const TrappedCall& call) {
  mq_attr attributes{};
  if (mq_getattr(queue.fd(), &attributes) != 0) return true;
  const auto size = static_cast<std::int64_t>(call.args[2]);
  const bool fits = call.number == SYS_mq_timedsend ? size <= attributes.mq_msgsize
                                                    : size >= attributes.mq_msgsize;
  return !fits || (attributes.mq_flags & O_NONBLOCK) != 0;
}

}  // namespace

KernelObject SyscallIpc::ObjectOf(const TrappedCall& call) {
  const bool is_queue =
      call.number == SYS_msgsnd || call.number == SYS_msgrcv || call.number == SYS_msgctl;
  const shm::KernelObjectKind kind =
      is_queue ? shm::KernelObjectKind::kMessages : shm::KernelObjectKind::kSemaphores;
  return {.kind = static_cast<std::int64_t>(kind), .id = static_cast<int>(call.args[0])};
}

std::int64_t SyscallIpc::ResultAtDeadline(const TrappedCall& call) {
  const bool is_queue = call.number == SYS_mq_timedsend || call.number == SYS_mq_timedreceive;
  return is_queue ? -ETIMEDOUT : -EAGAIN;
}

bool SyscallIpc::DeadlineAfter(const Task& task, std::uint64_t address,
                               VirtualTime* deadline) const {
  *deadline = VirtualTime::Never();
  if (address == 0) return true;
  timespec timeout{};
  if (!Read(task, address, &timeout) || !IsValid(timeout)) return false;
  *deadline = AtMostNever(task.reached, VirtualNs(ToTimeoutNs(timeout)));
  return true;
}

// Deadlines of queues are dates.
bool SyscallIpc::DeadlineAt(const Task& task, std::uint64_t address, VirtualTime* deadline) const {
  *deadline = VirtualTime::Never();
  if (address == 0) return true;
  timespec date{};
  if (!Read(task, address, &date) || !IsValid(date)) return false;
  const ProgramTime own = OwnTime(ToTimeoutNs(date) - run_.header->realtime_offset_ns);
  *deadline = std::max(task.process->clock.RobotTimeOf(own), task.reached);
  return true;
}

void SyscallIpc::OfSystemV(Task& task, const TrappedCall& call) {
  task.trap_continues = true;
  task.after_call = AfterCall::kObjects;
  VirtualTime deadline;
  const bool has_timeout = call.number == SYS_semtimedop && call.args[3] != 0;
  if (has_timeout && DeadlineAfter(task, call.args[3], &deadline) &&
      WouldWaitForSemaphores(task, call)) {
    return objects_.WaitInCall(task, ObjectOf(call), deadline);
  }
  task.expects_kernel = call.number != SYS_semctl && call.number != SYS_msgctl;
  waker_.HoldInCall(task, shm::NotificationKind::kRead);
}

void SyscallIpc::Queue(Task& task, const TrappedCall& call) {
  task.trap_continues = true;
  const bool sends = call.number == SYS_mq_timedsend;
  const short events = sends ? POLLOUT : POLLIN;
  const auto number = static_cast<int>(call.args[0]);
  const RemoteDescriptor queue(task, number);
  if (queue.fd() < 0) return;
  if (sends) {
    shm::NoteSent(SlotOf(task).receipts);
    if (run_.header->queues_notify.load() != 0) task.after_call = AfterCall::kSignals;
  }
  const bool is_ready = queue.IsReady(events);
  if (is_ready && !sends) activations_.ReceivedRaw(task, false);
  VirtualTime deadline;
  if (is_ready || IsRefused(queue, call) || !DeadlineAt(task, call.args[4], &deadline)) {
    return waker_.HoldInCall(task,
                             sends ? shm::NotificationKind::kWrite : shm::NotificationKind::kRead);
  }
  const shm::WaitFd waited{number, static_cast<std::uint32_t>(events)};
  awaited::Descriptors watched = descriptors_.Watch(task, &waited, 1);
  watched.transfers = true;
  watched.takes = watched.fds.size() == 1;
  watched.events = waited.events;
  descriptors_.GoBehind(task, watched);
  waker_.Wait(task, {.what = std::move(watched),
                     .deadline = deadline,
                     .is_in_trapped_call = true,
                     .is_date = true});
}

void SyscallIpc::AcceptSignal(Task& task, const TrappedCall& call) {
  task.trap_continues = true;
  constexpr std::uint64_t kSetSize = 8;
  constexpr std::uint64_t kNeverAccepted = SignalBit(SIGKILL) | SignalBit(SIGSTOP);
  std::uint64_t set = 0;
  VirtualTime deadline;
  if (call.args[3] != kSetSize || !Read(task, call.args[0], &set) ||
      !DeadlineAfter(task, call.args[2], &deadline)) {
    return;
  }
  set &= ~kNeverAccepted;
  const SignalSets sets = SignalsOf(run_, task);
  const bool is_pending = ((sets.own_pending | sets.shared_pending) & set) != 0;
  if (is_pending || deadline <= task.reached) {
    return waker_.HoldInCall(task, shm::NotificationKind::kRead);
  }
  waker_.Wait(task, {awaited::Signals{set}, deadline, true});
}

}  // namespace tcs
