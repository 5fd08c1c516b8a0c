// The port (coordinator/port/) to a simulated host: each function of it that the engine uses, in
// the place of the kernel's.
#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "coordinator/port/block_detector.h"
#include "coordinator/port/call_times.h"
#include "coordinator/port/clocks.h"
#include "coordinator/port/levels.h"
#include "coordinator/port/pidfds.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/thread_signals.h"
#include "coordinator/port/traps.h"
#include "coordinator/port/waits.h"
#include "tests/simulate/kernel.h"

namespace tcs {

namespace {

using simulate::Kernel;
using simulate::SimThread;

// What the coordinator's calls take.
constexpr std::int64_t kCallNs = 300, kProcFileNs = 3'000;

SimThread* Find(pid_t tid) {
  Kernel::This().Spend(kProcFileNs);
  return Kernel::This().Find(tid);
}

bool Lives(const SimThread* thread) {
  return thread != nullptr && thread->state != SimThread::State::kDead;
}

int OpenEmpty() {
  const int fd = eventfd(0, EFD_CLOEXEC);
  Kernel::This().descriptors().Open(fd);
  return fd;
}

std::int64_t CpuOf(const SimThread* thread) { return Lives(thread) ? thread->cpu_ns : -1; }

}  // namespace

// clocks.h: before the first simulation there is no machine, and no time.
std::uint64_t HostTsc() {
  Kernel::This().Spend(20);
  return Kernel::This().tsc();
}
std::uint64_t CalibrateTsc() { return std::uint64_t{1} << 31; }
std::int64_t HostClockNs(clockid_t) {
  Kernel::This().Spend(30);
  return Kernel::This().now_ns();
}
std::int64_t ProcessCpuClockNs(pid_t pid) { return CpuOf(Find(pid)); }
int OpenThreadCpuClock(pid_t tid) {
  const int fd = OpenEmpty();
  Kernel::This().OpensClock(fd, tid);
  return fd;
}
std::int64_t ReadThreadCpuClock(int fd) {
  Kernel::This().Spend(kProcFileNs);
  return CpuOf(Kernel::This().OfClock(fd));
}

// levels.h
bool BindTo(pid_t, int) { return true; }
bool IsBoundTo(pid_t, int) { return true; }
void UseNoLevels() {}
bool SetLevel(pid_t tid, Level level) {
  if (!Kernel::This().has_levels()) return false;
  Kernel::This().Spend(kCallNs);
  if (SimThread* thread = Kernel::This().Find(tid); thread != nullptr)
    Kernel::This().SetLevel(*thread, static_cast<int>(level));
  return true;
}
void RunOnlyWhenIdle(pid_t) {}
void BeWokenInTime() {}
void LeaveRealTime(pid_t) {}

// call_times.h
CallTimes MeasureCalls() { return {}; }

// pidfds.h
int OpenPidfd(pid_t pid) {
  const int fd = OpenEmpty();
  Kernel::This().Watch(fd, pid);
  return fd;
}
void KillByPidfd(int pidfd) {
  Kernel::This().Spend(kCallNs);
  Kernel::This().KillWatched(pidfd);
}
int DuplicateFd(int, int) {
  errno = EBADF;
  return -1;
}
int WhyNoDuplicates() { return 0; }

// proc_files.h
ComputedTimes ComputedBy(pid_t) { return {.user_ns = 0, .system_ns = Kernel::This().now_ns()}; }
char ThreadState(pid_t tid) {
  const SimThread* const thread = Find(tid);
  if (!Lives(thread)) return 'X';
  return thread->state == SimThread::State::kRuns ? 'R' : 'S';
}
bool IsMarkedForSignal(pid_t tid) { return ThreadState(tid) == 'R'; }
bool IsInUserMode(pid_t) { return false; }
pid_t ParentOf(pid_t) { return 1; }
bool IsExiting(pid_t tid) {
  const SimThread* const thread = Find(tid);
  return Lives(thread) && thread->is_dying;
}
bool IsDying(pid_t tid) {
  const SimThread* const thread = Find(tid);
  return thread == nullptr || thread->is_dying;
}
std::optional<int> WaitStatusOf(pid_t child) {
  return Kernel::This().HasEnded(child) ? std::optional<int>(SIGKILL) : std::nullopt;
}
std::optional<int> EndOf(pid_t) { return std::nullopt; }
SignalSets ReadSignalSets(pid_t tid) {
  const SimThread* const thread = Find(tid);
  if (thread == nullptr) return {};
  return {.caught = Kernel::This().Caught(),
          .blocked = thread->blocked_signals,
          .own_pending = thread->pending,
          .shared_pending = thread->process.pending};
}
Credentials ReadCredentials(pid_t) { return {}; }
std::uint64_t ReadSoftLimit(pid_t, const char*) { return 0; }
std::string ThreadSystemCall(pid_t) { return "0"; }
std::optional<int> DescriptorOfIoctl(pid_t) { return std::nullopt; }
std::string ProgramOf(pid_t pid) { return "pid " + std::to_string(pid); }
std::vector<pid_t> ThreadsOf(pid_t pid) { return Kernel::This().ThreadsOf(pid); }
pid_t ProcessOfThread(pid_t tid) {
  const SimThread* const thread = Find(tid);
  return thread == nullptr ? -1 : thread->process.pid;
}
pid_t TracerOf(pid_t) { return 0; }
bool IsThreadOf(pid_t pid, pid_t tid) { return ProcessOfThread(tid) == pid; }
bool DescendsFrom(pid_t, pid_t) { return true; }
std::vector<pid_t> ChildrenOf(pid_t) { return {}; }

// thread_signals.h
void SendTimerSignal(const TimerSignalRequest& request) {
  Kernel::This().Spend(kCallNs);
  Kernel::This().SendTimer(request);
}
void SendToGate(pid_t, pid_t tid, std::uint64_t dispatch) {
  Kernel::This().Spend(kCallNs);
  Kernel::This().SendToGate(tid, dispatch);
}

// traps.h: all programs are in this process's memory.
std::optional<TrappedCall> ReceiveTrapped(int listener) {
  Kernel::This().Spend(kCallNs);
  return Kernel::This().ReceiveTrapped(listener);
}
bool AnswerTrapped(int, std::uint64_t id, std::int64_t result) {
  Kernel::This().Spend(kCallNs);
  return Kernel::This().Answer(id, result);
}
bool AnswerTrappedByFile(int, std::uint64_t, int, bool) { return false; }
int PutFileInto(int, std::uint64_t, int, bool) { return -1; }
bool ContinueTrapped(int, std::uint64_t id) { return Kernel::This().Answer(id, 0); }
bool GiveDescriptor(const TrappedCall&, int, int) { return false; }
bool HasAnswerToTake(int, std::uint64_t id) {
  Kernel::This().Spend(kCallNs);
  return Kernel::This().HasAnswerToTake(id);
}
bool ReadMemory(pid_t, std::uint64_t address, void* to, std::size_t size) {
  Kernel::This().Spend(kCallNs);
  memcpy(to, reinterpret_cast<const void*>(address), size);
  return true;
}
bool ReadMemory(pid_t pid, const RemotePiece& first, const RemotePiece& second) {
  return ReadMemory(pid, first.address, first.to, first.size) &&
         ReadMemory(pid, second.address, second.to, second.size);
}
bool WriteMemory(pid_t, std::uint64_t address, const void* from, std::size_t size) {
  memcpy(reinterpret_cast<void*>(address), from, size);
  return true;
}
bool ReadMemory(pid_t, const std::vector<iovec>&, void*, std::size_t) { return false; }
bool WriteMemory(pid_t, const std::vector<iovec>&, const void*, std::size_t) { return false; }
int WhyNoLooksInto(pid_t) { return 0; }

// waits.h
int MakeWaitSet() { return OpenEmpty(); }
bool ChangeWaitSet(int set, int operation, int fd, epoll_event* event) {
  return Kernel::This().descriptors().ChangeSet(set, operation, fd, event);
}
std::size_t WaitForEvents(int set, std::span<epoll_event> events, HostDuration timeout) {
  Kernel& kernel = Kernel::This();
  const auto look = [&] { return kernel.descriptors().IsReadable(set); };
  if (look()) {
    kernel.Spend(kCallNs);
  } else {
    kernel.Sleep(look, timeout.ns());
  }
  return kernel.descriptors().TakeEvents(set, events);
}
bool IsReadable(int fd) { return Kernel::This().descriptors().IsReadable(fd); }
ssize_t ReadPipe(int fd, void* to, std::size_t size) {
  return Kernel::This().descriptors().Read(fd, to, size);
}
void AwaitReadable(int fd, HostDuration at_most) {
  const auto look = [fd] { return IsReadable(fd); };
  if (!look()) Kernel::This().Sleep(look, at_most.ns());
}
void Pause(HostDuration duration) {
  Kernel::This().Sleep([] { return false; }, duration.ns());
}
void WakeAt(std::atomic<std::uint32_t>& word) {
  Kernel::This().Spend(kCallNs);
  Kernel::This().WakeAt(word);
}

// block_detector.h
BlockDetector::~BlockDetector() = default;
std::string BlockDetector::Start() {
  fired_.Reset(OpenEmpty());
  pidfd_.Reset(OpenPidfd(0));
  pid_ = getpid();
  return {};
}
void BlockDetector::Arm() {
  if (armed_) return;
  armed_ = true;
  Kernel::This().ArmDetector(fired_.get());
}
bool BlockDetector::TakeFired() {
  if (!Kernel::This().descriptors().Take(fired_.get())) return false;
  armed_ = false;
  return true;
}
bool BlockDetector::IsDying() const { return false; }
std::string BlockDetector::HowItEnded() const { return "it has not"; }

}  // namespace tcs
