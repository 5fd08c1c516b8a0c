#include "coordinator/calls/syscall_scheduling.h"

#include <errno.h>
#include <limits.h>
#include <linux/sched.h>
#include <sched.h>
#include <sys/syscall.h>

#include <algorithm>
#include <cstddef>

#include "coordinator/tasks/client_values.h"

namespace tcs {

namespace {

// The kernel's struct sched_attr in its first version; later ones have more behind.
struct Attributes {
  std::uint32_t size = 0, policy = 0;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime = 0, deadline = 0, period = 0;
};
constexpr std::uint32_t kPageSize = 4096, kFirstAttributes = 48, kWholeAttributes = 56;
static_assert(sizeof(Attributes) == kFirstAttributes);

// A period that is not given is as long as the deadline. Times beyond all bounds are no times.
DeadlineParameters DeadlineOf(const Attributes& attributes) {
  const auto time = [](std::uint64_t ns) {
    return static_cast<std::int64_t>(ns) < 0 ? 0 : static_cast<std::int64_t>(ns);
  };
  if (attributes.policy != SCHED_DEADLINE) return {};
  const std::uint64_t period = attributes.period == 0 ? attributes.deadline : attributes.period;
  return {.runtime_ns = time(attributes.runtime),
          .deadline_ns = time(attributes.deadline),
          .period_ns = time(period)};
}

}  // namespace

std::int64_t SyscallScheduling::SetScheduling(Task& task, Task* of, const TrappedCall& call) {
  const bool keeps = call.number == SYS_sched_setparam;
  sched_param param{};
  if (!Read(task, call.args[keeps ? 1 : 2], &param)) return -EFAULT;
  const std::int64_t policy = keeps ? shm::kKeepPolicy : static_cast<int>(call.args[1]);
  if (of == nullptr) {
    const auto tid = static_cast<pid_t>(call.args[0]);
    return SchedulingCalls::ErrorForStranger(tid, policy, param.sched_priority);
  }
  return calls_.SetPriority(task, *of, policy, param.sched_priority);
}

std::int64_t SyscallScheduling::SetAttributes(Task& task, Task& of, const TrappedCall& call) {
  Attributes attributes;
  if (!Read(task, call.args[1], &attributes.size)) return -EFAULT;
  if (attributes.size == 0) attributes.size = kFirstAttributes;
  if (attributes.size < kFirstAttributes || attributes.size > kPageSize) {
    Write(task, call.args[1], kWholeAttributes);
    return -E2BIG;
  }
  if (!Read(task, call.args[1], &attributes)) return -EFAULT;
  if (static_cast<std::int32_t>(attributes.policy) < 0) return -EINVAL;
  if ((attributes.flags & ~std::uint64_t{SCHED_FLAG_ALL}) != 0) return -EINVAL;
  SchedulingParameters wanted = ParametersOf(of);
  if ((attributes.flags & SCHED_FLAG_KEEP_POLICY) == 0) {
    wanted.policy = static_cast<int>(attributes.policy);
    wanted.resets_on_fork = (attributes.flags & SCHED_FLAG_RESET_ON_FORK) != 0;
  }
  if ((attributes.flags & SCHED_FLAG_KEEP_PARAMS) == 0) {
    wanted.priority = static_cast<int>(std::min<std::uint32_t>(attributes.priority, INT_MAX));
    wanted.deadline = DeadlineOf(attributes);
  }
  return calls_.Schedule(task, of, wanted);
}

std::int64_t SyscallScheduling::GetAttributes(Task& task, const Task& of, const TrappedCall& call) {
  const auto room = static_cast<std::uint32_t>(call.args[2]);
  if (room > kPageSize || room < kFirstAttributes || call.args[3] != 0) return -EINVAL;
  struct {
    Attributes first;
    std::uint32_t least = 0, most = 1024;  // of utilization, where nothing is clamped
  } answer;
  static_assert(sizeof answer == kWholeAttributes);
  const std::uint32_t size = std::min(room, kWholeAttributes);
  answer.first.size = size;
  const SchedulingParameters& parameters = ParametersOf(of);
  answer.first.policy = static_cast<std::uint32_t>(parameters.policy);
  answer.first.flags = parameters.resets_on_fork ? SCHED_FLAG_RESET_ON_FORK : 0;
  answer.first.priority = static_cast<std::uint32_t>(parameters.priority);
  if (parameters.policy == SCHED_DEADLINE) {
    answer.first.runtime = static_cast<std::uint64_t>(parameters.deadline.runtime_ns);
    answer.first.deadline = static_cast<std::uint64_t>(parameters.deadline.deadline_ns);
    answer.first.period = static_cast<std::uint64_t>(parameters.deadline.period_ns);
  }
  return WriteMemory(task.process->pid, call.args[1], &answer, size) ? 0 : -EFAULT;
}

std::int64_t SyscallScheduling::GetScheduling(Task& task, Task& of, const TrappedCall& call) {
  switch (call.number) {
    case SYS_sched_getscheduler:
      return ParametersOf(of).PolicyAndFlag();
    case SYS_sched_getparam:
      return Write(task, call.args[1], sched_param{ParametersOf(of).priority}) ? 0 : -EFAULT;
    case SYS_sched_rr_get_interval: {
      constexpr timespec kRoundRobin{0, 100'000'000};
      return Write(task, call.args[1],
                   ParametersOf(of).policy == SCHED_RR ? kRoundRobin : timespec{})
                 ? 0
                 : -EFAULT;
    }
    case SYS_sched_getattr:
      return GetAttributes(task, of, call);
    default: {  // SYS_sched_getaffinity
      const auto size = static_cast<std::uint32_t>(call.args[1]);
      if (size < sizeof(std::uint64_t) || size % sizeof(std::uint64_t) != 0) return -EINVAL;
      const std::uint64_t cores = SchedulerOf(of).CoresOf(of.order);
      return Write(task, call.args[2], cores) ? std::int64_t{sizeof cores} : -EFAULT;
    }
  }
}

std::int64_t SyscallScheduling::CoreOf(const Task& task, const TrappedCall& call) {
  const std::uint32_t core = task.cpu == nullptr ? 0 : task.cpu->core, node = 0;
  if (call.args[0] != 0 && !Write(task, call.args[0], core)) return -EFAULT;
  return call.args[1] == 0 || Write(task, call.args[1], node) ? 0 : -EFAULT;
}

std::int64_t SyscallScheduling::Call(Task& task, const TrappedCall& call) {
  const auto tid = static_cast<pid_t>(call.args[0]);
  const bool has_pointer =
      call.number != SYS_sched_getscheduler && call.number != SYS_sched_setaffinity &&
      call.number != SYS_sched_getaffinity && call.number != SYS_sched_rr_get_interval;
  const std::uint64_t pointer = call.args[call.number == SYS_sched_setscheduler ? 2 : 1];
  const bool is_of_affinity =
      call.number == SYS_sched_setaffinity || call.number == SYS_sched_getaffinity;
  if ((tid < 0 && !is_of_affinity) || (has_pointer && pointer == 0)) return -EINVAL;
  if (call.number == SYS_sched_setscheduler && static_cast<int>(call.args[1]) < 0) return -EINVAL;
  Task* of = tid == 0 ? &task : run_.table.Named(*task.process, tid);
  switch (call.number) {
    case SYS_sched_setscheduler:
    case SYS_sched_setparam:
      return SetScheduling(task, of, call);
    case SYS_sched_setattr:
      if (call.args[2] != 0) return -EINVAL;
      return of == nullptr ? -ESRCH : SetAttributes(task, *of, call);
    case SYS_sched_setaffinity: {
      std::uint64_t cores = 0;
      const std::size_t size = std::min<std::size_t>(call.args[1], sizeof cores);
      if (!ReadMemory(task.process->pid, call.args[2], &cores, size)) return -EFAULT;
      return of == nullptr ? -ESRCH : calls_.SetAffinity(task, *of, cores);
    }
    default:
      return of == nullptr ? -ESRCH : GetScheduling(task, *of, call);
  }
}

}  // namespace tcs
