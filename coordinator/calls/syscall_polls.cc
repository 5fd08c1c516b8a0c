#include "coordinator/calls/syscall_polls.h"

#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/syscall.h>
#include <time.h>

#include <algorithm>
#include <utility>

#include "coordinator/os/open_files.h"
#include "coordinator/os/signal_bits.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/client_values.h"
#include "coordinator/tasks/remote_descriptor.h"

namespace tcs {

namespace {

constexpr std::size_t kMostPolled = 65'536, kSets = 3;

// Whether the size that goes with a mask, if there is one, is right.
bool IsSoundMask(std::uint64_t mask, std::uint64_t size) { return mask == 0 || size == 8; }

std::optional<std::vector<shm::WaitFd>> PolledFds(const Task& task, const TrappedCall& call) {
  rlimit most{};
  prlimit(task.process->pid, RLIMIT_NOFILE, nullptr, &most);
  if (call.args[1] > most.rlim_cur) return std::nullopt;
  if (call.number == SYS_ppoll && !IsSoundMask(call.args[3], call.args[4])) return std::nullopt;
  std::vector<pollfd> fds(std::min<std::size_t>(call.args[1], kMostPolled));
  if (!fds.empty() &&
      !ReadMemory(task.process->pid, call.args[0], fds.data(), fds.size() * sizeof fds[0])) {
    return std::nullopt;
  }
  std::vector<shm::WaitFd> waited;
  for (const pollfd& fd : fds) {
    if (fd.fd >= 0) waited.push_back({fd.fd, static_cast<unsigned short>(fd.events)});
  }
  return waited;
}

// How many descriptors the kernel looks at: no more than the process's table has room for.
std::size_t SelectedCount(const Task& task, const TrappedCall& call) {
  const auto count = static_cast<std::size_t>(std::max(0, static_cast<int>(call.args[0])));
  return count <= FD_SETSIZE ? count : std::min(count, RoomForDescriptors(task.process->pid));
}

std::size_t WordsOf(std::size_t fds) { return (fds + 63) / 64; }

std::optional<std::vector<shm::WaitFd>> SelectedFds(const Task& task, const TrappedCall& call) {
  if (static_cast<int>(call.args[0]) < 0) return std::nullopt;
  const std::size_t count = SelectedCount(task, call);
  std::vector<std::uint64_t> sets[kSets];
  for (std::size_t i = 0; i < kSets; ++i) {
    sets[i].resize(WordsOf(count));
    if (call.args[i + 1] == 0 || count == 0) continue;
    if (!ReadMemory(task.process->pid, call.args[i + 1], sets[i].data(),
                    sets[i].size() * sizeof sets[i][0])) {
      return std::nullopt;
    }
  }
  constexpr std::uint32_t kEvents[kSets] = {EPOLLIN, EPOLLOUT, EPOLLPRI};
  std::vector<shm::WaitFd> waited;
  for (std::size_t fd = 0; fd < count; ++fd) {
    std::uint32_t events = 0;
    for (std::size_t i = 0; i < kSets; ++i) {
      if ((sets[i][fd / 64] >> (fd % 64) & 1) != 0) events |= kEvents[i];
    }
    if (events != 0) waited.push_back({static_cast<int>(fd), events});
  }
  return waited;
}

bool IsOfSet(const TrappedCall& call) {
  return call.number == SYS_epoll_wait || call.number == SYS_epoll_pwait ||
         call.number == SYS_epoll_pwait2;
}

bool IsSoundEpollWait(const Task& task, const TrappedCall& call) {
  constexpr int kMostEvents = INT_MAX / static_cast<int>(sizeof(epoll_event));
  const int most = static_cast<int>(call.args[2]);
  if (most <= 0 || most > kMostEvents || static_cast<std::int64_t>(call.args[1]) < 0) return false;
  if (call.number != SYS_epoll_wait && !IsSoundMask(call.args[4], call.args[5])) return false;
  return IsAnonymous(task.process->pid, static_cast<int>(call.args[0]), kEpollSet);
}

}  // namespace

std::int64_t SyscallPolls::Poll(Task& task, const TrappedCall& call) {
  std::int64_t timeout_ns = 0;
  task.trap_continues = true;
  // The kernel says best what is wrong with the call.
  if (!TimeoutOf(task, call, &timeout_ns) || !MaskOf(task, call).has_value()) return 0;
  const auto waited = FdsOf(task, call);
  if (!waited.has_value()) return 0;
  std::vector<DescriptorWaits::Copy> copies;
  const bool ready = std::any_of(waited->begin(), waited->end(), [&](const shm::WaitFd& fd) {
    RemoteDescriptor looked_at(task, fd.fd);
    const bool is_closed = looked_at.fd() < 0 && errno == EBADF;  // which the kernel says at once
    if (is_closed || looked_at.IsReady(static_cast<short>(fd.events))) return true;
    copies.push_back({fd, looked_at.Take()});
    return false;
  });
  if (timeout_ns == 0 || ready) {
    waker_.HoldInCall(task, shm::NotificationKind::kRead);
    return 0;
  }
  const VirtualTime deadline =
      timeout_ns < 0 ? VirtualTime::Never() : AtMostNever(task.reached, VirtualNs(timeout_ns));
  awaited::Descriptors watched = descriptors_.Watch(task, std::move(copies));
  watched.keep = IsOfSet(call) ? shm::KeepFiles::kForCall : shm::KeepFiles::kForPoll;
  watched.signals = SignalsOf(task, call);
  waker_.Wait(task, {std::move(watched), deadline, true});
  return 0;
}

// The timeout of a call that waits for descriptors: false if it is not there, or not valid.
bool SyscallPolls::TimeoutOf(Task& task, const TrappedCall& call, std::int64_t* ns) {
  const auto in_ms = [](std::uint64_t argument) {
    return shm::MillisecondsToNs(static_cast<int>(argument));
  };
  *ns = -1;
  timespec t{};
  switch (call.number) {
    case SYS_poll:
      *ns = in_ms(call.args[2]);
      return true;
    case SYS_epoll_wait:
    case SYS_epoll_pwait:
      *ns = in_ms(call.args[3]);
      return true;
    case SYS_select: {
      timeval tv{};
      if (call.args[4] == 0) return true;
      if (!Read(task, call.args[4], &tv)) return false;
      t = {tv.tv_sec + tv.tv_usec / 1'000'000, tv.tv_usec % 1'000'000 * 1000};
      break;
    }
    default: {
      const std::uint64_t address = call.args[call.number == SYS_ppoll      ? 2
                                              : call.number == SYS_pselect6 ? 4
                                                                            : 3];
      if (address == 0) return true;
      if (!Read(task, address, &t)) return false;
    }
  }
  if (!IsValid(t)) return false;
  *ns = ToTimeoutNs(t);
  return true;
}

// The descriptors that the call waits for; none where something is wrong with the call, which the
// kernel says best.
std::optional<std::vector<shm::WaitFd>> SyscallPolls::FdsOf(const Task& task,
                                                            const TrappedCall& call) {
  switch (call.number) {
    case SYS_poll:
    case SYS_ppoll:
      return PolledFds(task, call);
    case SYS_select:
    case SYS_pselect6:
      return SelectedFds(task, call);
    default:
      if (!IsSoundEpollWait(task, call)) return std::nullopt;
      return std::vector{shm::WaitFd{static_cast<int>(call.args[0]), EPOLLIN}};
  }
}

// The address of the mask that the call sets while it waits: none where there is something wrong
// with the mask. 0: the call sets none.
std::optional<std::uint64_t> SyscallPolls::MaskOf(const Task& task, const TrappedCall& call) {
  std::uint64_t mask[2] = {0, sizeof(std::uint64_t)};  // where it is, and its size
  switch (call.number) {
    case SYS_ppoll:
      mask[0] = call.args[3];
      mask[1] = call.args[4];
      break;
    case SYS_pselect6:
      if (call.args[5] != 0 && !Read(task, call.args[5], &mask)) return std::nullopt;
      break;
    case SYS_epoll_pwait:
    case SYS_epoll_pwait2:
      mask[0] = call.args[4];
      mask[1] = call.args[5];
      break;
    default:
      break;
  }
  std::uint64_t set = 0;
  const bool is_wrong = mask[0] != 0 && (mask[1] != sizeof set || !Read(task, mask[0], &set));
  return is_wrong ? std::nullopt : std::optional(mask[0]);
}

// The signals that end the call though the thread blocks them: the call's mask lets them in.
// Signals that do nothing, or only stop the thread, do not end it.
std::uint64_t SyscallPolls::SignalsOf(const Task& task, const TrappedCall& call) {
  constexpr std::uint64_t kNoEnd = SignalBit(SIGCHLD) | SignalBit(SIGCONT) | SignalBit(SIGURG) |
                                   SignalBit(SIGWINCH) | SignalBit(SIGTSTP) | SignalBit(SIGTTIN) |
                                   SignalBit(SIGTTOU);
  constexpr std::uint64_t kNeverHeld = SignalBit(SIGKILL) | SignalBit(SIGSTOP);
  const std::uint64_t address = MaskOf(task, call).value_or(0);
  std::uint64_t mask = 0;
  if (address == 0 || !Read(task, address, &mask)) return 0;
  const SignalSets sets = ReadSignalSets(task.tid);
  return ~mask & ~kNeverHeld & ~sets.ignored & ~(kNoEnd & ~sets.caught);
}

namespace {

// The events at the file that is under a number now, of those asked for and of those that nobody
// has to ask for.
std::uint32_t EventsAt(const Task& task, int number, std::uint32_t asked) {
  const RemoteDescriptor looked_at(task, number);
  if (looked_at.fd() < 0) return errno == EBADF ? POLLNVAL : 0;
  pollfd probe{looked_at.fd(), static_cast<short>(asked), 0};
  poll(&probe, 1, 0);
  return static_cast<unsigned short>(probe.revents);
}

std::int64_t PollByNumber(const Task& task, const TrappedCall& call) {
  std::vector<pollfd> fds(std::min<std::size_t>(call.args[1], kMostPolled));
  const std::size_t size = fds.size() * sizeof(pollfd);
  if (!ReadMemory(task.process->pid, call.args[0], fds.data(), size)) return -EFAULT;
  std::int64_t found = 0;
  for (pollfd& fd : fds) {
    const auto events = static_cast<unsigned short>(fd.events);
    fd.revents = fd.fd < 0 ? short{0} : static_cast<short>(EventsAt(task, fd.fd, events));
    found += fd.revents != 0;
  }
  return WriteMemory(task.process->pid, call.args[0], fds.data(), size) ? found : -EFAULT;
}

// The descriptors in each set are those with one of these events. A descriptor that has been closed
// meanwhile is in all sets.
constexpr std::uint32_t kInSet[kSets] = {POLLIN | POLLRDNORM | POLLRDBAND | POLLHUP | POLLERR,
                                         POLLOUT | POLLWRNORM | POLLWRBAND | POLLERR, POLLPRI};

std::int64_t SelectByNumber(const Task& task, const TrappedCall& call) {
  const auto waited = SelectedFds(task, call);
  if (!waited.has_value()) return -EFAULT;
  constexpr std::uint32_t kAsks[kSets] = {EPOLLIN, EPOLLOUT, EPOLLPRI};
  std::vector<std::uint64_t> sets[kSets];
  for (std::vector<std::uint64_t>& set : sets) set.resize(WordsOf(SelectedCount(task, call)));
  std::int64_t found = 0;
  for (const shm::WaitFd& fd : *waited) {
    const std::uint32_t events = EventsAt(task, fd.fd, fd.events);
    for (std::size_t i = 0; i < kSets; ++i) {
      if ((fd.events & kAsks[i]) == 0 || (events & (kInSet[i] | POLLNVAL)) == 0) continue;
      const auto number = static_cast<std::size_t>(fd.fd);
      sets[i][number / 64] |= std::uint64_t{1} << (number % 64);
      ++found;
    }
  }
  if (found == 0) return 0;
  for (std::size_t i = 0; i < kSets; ++i) {
    if (call.args[i + 1] != 0 && !WriteMemory(task.process->pid, call.args[i + 1], sets[i].data(),
                                              sets[i].size() * sizeof sets[i][0])) {
      return -EFAULT;
    }
  }
  return found;
}

}  // namespace

std::int64_t SyscallPolls::Again(const Task& task, const TrappedCall& call, int file) {
  if (!IsOfSet(call)) {
    const bool selects = call.number == SYS_select || call.number == SYS_pselect6;
    return selects ? SelectByNumber(task, call) : PollByNumber(task, call);
  }
  constexpr int kMostTaken = 1024;
  epoll_event events[kMostTaken];
  const int count =
      epoll_wait(file, events, std::min(kMostTaken, static_cast<int>(call.args[2])), 0);
  if (count <= 0) return count < 0 ? -errno : 0;
  const std::size_t size = static_cast<std::size_t>(count) * sizeof events[0];
  return WriteMemory(task.process->pid, call.args[1], events, size) ? count : -EFAULT;
}

void SyscallPolls::ClearResult(const Task& task, const TrappedCall& call) {
  if (call.number == SYS_poll || call.number == SYS_ppoll) {
    const short none = 0;
    const std::size_t count = std::min<std::size_t>(call.args[1], kMostPolled);
    for (std::size_t i = 0; i < count; ++i) {
      Write(task, call.args[0] + i * sizeof(pollfd) + offsetof(pollfd, revents), none);
    }
  }
  if (call.number == SYS_select || call.number == SYS_pselect6) {
    const std::vector<std::uint64_t> none(WordsOf(SelectedCount(task, call)));
    for (std::size_t i = 1; i <= kSets; ++i) {
      if (call.args[i] == 0) continue;
      WriteMemory(task.process->pid, call.args[i], none.data(), none.size() * sizeof none[0]);
    }
  }
}

}  // namespace tcs
