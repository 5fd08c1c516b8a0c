#include "coordinator/os/host.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/close_range.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <x86gprintrin.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include "coordinator/os/open_file_limit.h"
#include "coordinator/os/passed_fd.h"
#include "coordinator/os/say.h"
#include "coordinator/os/unique_fd.h"
#include "shm/clock_ids.h"
#include "shm/layout.h"
#include "shm/time_values.h"

namespace tcs {

std::int64_t HostClockNs(clockid_t id) {
  timespec t;
  clock_gettime(id, &t);
  return shm::ToNs(t);
}

namespace {

// One instant by both clocks.
struct TscReading {
  std::uint64_t tsc;
  std::int64_t raw_ns;
};

// The tightest of some: where the host was away between the two, they are of no one instant.
TscReading ReadTsc() {
  TscReading best{};
  std::uint64_t least_ticks = UINT64_MAX;
  for (int i = 0; i < 8; ++i) {
    const std::uint64_t before_tsc = __rdtsc();
    const std::int64_t raw_ns = HostClockNs(CLOCK_MONOTONIC_RAW);
    const std::uint64_t ticks = __rdtsc() - before_tsc;
    if (ticks >= least_ticks) continue;
    least_ticks = ticks;
    best = {before_tsc + ticks / 2, raw_ns};
  }
  return best;
}

constexpr std::int64_t kCalibrationNs = 10'000'000;

// When the process was loaded: a run has much to prepare before it asks for the rate.
const TscReading tsc_at_load = ReadTsc();

}  // namespace

std::uint64_t CalibrateTsc() {
  const std::int64_t left_ns =
      tsc_at_load.raw_ns + kCalibrationNs - HostClockNs(CLOCK_MONOTONIC_RAW);
  timespec left = shm::ToTimespec(std::max<std::int64_t>(left_ns, 0));
  while (nanosleep(&left, &left) != 0 && errno == EINTR) continue;
  const TscReading now = ReadTsc();
  return static_cast<std::uint64_t>(static_cast<double>(now.raw_ns - tsc_at_load.raw_ns) /
                                    static_cast<double>(now.tsc - tsc_at_load.tsc) * 4294967296.0);
}

namespace {

constexpr unsigned kExiting = 0x4;  // PF_EXITING

bool uses_no_levels = false;

}  // namespace

bool BindTo(pid_t tid, int cpu) {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(static_cast<std::size_t>(cpu), &one);
  return sched_setaffinity(tid, sizeof one, &one) == 0;
}

bool IsBoundTo(pid_t tid, int cpu) {
  cpu_set_t cpus;
  return sched_getaffinity(tid, sizeof cpus, &cpus) == 0 && CPU_COUNT(&cpus) == 1 &&
         CPU_ISSET(static_cast<std::size_t>(cpu), &cpus);
}

void UseNoLevels() { uses_no_levels = true; }

bool SetLevel(pid_t tid, Level level) {
  if (uses_no_levels) return false;
  const sched_param param{static_cast<int>(level)};
  return sched_setscheduler(tid, SCHED_FIFO, &param) == 0;
}

void RunOnlyWhenIdle(pid_t tid) {
  const sched_param param{0};
  sched_setscheduler(tid, SCHED_IDLE, &param);
}

void BeWokenInTime() { prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0); }

void LeaveRealTime(pid_t tid) {
  const sched_param param{0};
  sched_setscheduler(tid, SCHED_OTHER, &param);
}

std::int64_t ProcessCpuClockNs(pid_t pid) {
  timespec t;
  return clock_gettime(shm::CpuClockOf(pid), &t) == 0 ? shm::ToNs(t) : -1;
}

// A thread's own clock can be read by its own process only; this is the same number.
int OpenThreadCpuClock(pid_t tid) {
  char path[64];
  snprintf(path, sizeof path, "/proc/%d/schedstat", tid);
  return open(path, O_RDONLY | O_CLOEXEC);
}

std::int64_t ReadThreadCpuClock(int fd) {
  char text[128];
  const ssize_t n = pread(fd, text, sizeof text - 1, 0);
  if (n <= 0) return -1;
  text[n] = '\0';
  return strtoll(text, nullptr, 10);
}

namespace {

struct ThreadStat {
  char state = 'X';
  pid_t parent = -1;
  unsigned flags = 0;  // the kernel's PF_*
  unsigned long user_ticks = 0, system_ticks = 0;
};

ThreadStat ReadThreadStat(pid_t tid) {
  char path[64], text[512];
  snprintf(path, sizeof path, "/proc/%d/stat", tid);
  const UniqueFd fd(open(path, O_RDONLY | O_CLOEXEC));
  if (!fd) return {};
  const ssize_t n = read(fd.get(), text, sizeof text - 1);
  text[std::max<ssize_t>(n, 0)] = '\0';
  // The name may hold anything; the state follows its last parenthesis.
  const char* end = strrchr(text, ')');
  ThreadStat stat;
  if (end == nullptr) return {};
  const int found =
      sscanf(end + 1, " %c %d %*d %*d %*d %*d %u %*u %*u %*u %*u %lu %lu", &stat.state,
             &stat.parent, &stat.flags, &stat.user_ticks, &stat.system_ticks);
  return found == 5 ? stat : ThreadStat{};
}

}  // namespace

char ThreadState(pid_t tid) { return ReadThreadStat(tid).state; }

ComputedTimes ComputedBy(pid_t pid) {
  const ThreadStat stat = ReadThreadStat(pid);
  const std::int64_t tick_ns = shm::kNsPerSecond / sysconf(_SC_CLK_TCK);
  return {static_cast<std::int64_t>(stat.user_ticks) * tick_ns,
          static_cast<std::int64_t>(stat.system_ticks) * tick_ns};
}

bool IsMarkedForSignal(pid_t tid) {
  const char state = ThreadState(tid);
  return state == 'R' || state == 'D';
}

bool IsInUserMode(pid_t tid) {
  std::ifstream stack("/proc/" + std::to_string(tid) + "/stack");
  std::string innermost;
  return std::getline(stack, innermost) && innermost.find("exit_to_user_mode") != std::string::npos;
}

pid_t ParentOf(pid_t pid) { return ReadThreadStat(pid).parent; }

bool IsExiting(pid_t tid) {
  const ThreadStat stat = ReadThreadStat(tid);
  return (stat.state == 'R' || stat.state == 'D') && (stat.flags & kExiting) != 0;
}

bool IsDying(pid_t tid) {
  const ThreadStat stat = ReadThreadStat(tid);
  if (stat.state == 'Z' || stat.state == 'X' || (stat.flags & kExiting) != 0) return true;
  return (ReadSignalSets(tid).own_pending >> (SIGKILL - 1) & 1) != 0;
}

std::optional<int> WaitStatusOf(pid_t child) {
  siginfo_t info{};
  if (waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
      info.si_pid != child) {
    return std::nullopt;
  }
  if (info.si_code == CLD_EXITED) return W_EXITCODE(info.si_status, 0);
  return W_EXITCODE(0, info.si_status) | (info.si_code == CLD_DUMPED ? WCOREFLAG : 0);
}

std::optional<int> EndOf(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t name_end = text.rfind(") Z "), last = text.rfind(' ');
  if (name_end == std::string::npos || last == std::string::npos) return std::nullopt;
  return atoi(text.c_str() + last + 1);
}

namespace {

// Of /proc/TID/status: null without it, else `text`.
const char* ReadStatus(pid_t tid, char (&text)[4096]) {
  char path[64];
  snprintf(path, sizeof path, "/proc/%d/status", tid);
  const UniqueFd fd(open(path, O_RDONLY | O_CLOEXEC));
  if (!fd) return nullptr;
  const ssize_t n = read(fd.get(), text, sizeof text - 1);
  text[std::max<ssize_t>(n, 0)] = '\0';
  return text;
}

std::optional<pid_t> PidIn(const char* status, const char* name) {
  const char* found = status == nullptr ? nullptr : strstr(status, name);
  if (found == nullptr) return std::nullopt;
  return static_cast<pid_t>(strtol(found + strlen(name), nullptr, 10));
}

}  // namespace

Credentials ReadCredentials(pid_t tid) {
  Credentials credentials;
  char buffer[4096];
  const char* text = ReadStatus(tid, buffer);
  if (text == nullptr) return credentials;
  constexpr char kUids[] = "\nUid:", kCapabilities[] = "\nCapEff:";
  if (const char* found = strstr(text, kUids); found != nullptr) {
    char* next = nullptr;
    credentials.real_uid = static_cast<uid_t>(strtoul(found + sizeof kUids - 1, &next, 10));
    credentials.effective_uid = static_cast<uid_t>(strtoul(next, nullptr, 10));
  }
  if (const char* found = strstr(text, kCapabilities); found != nullptr) {
    credentials.capabilities = strtoull(found + sizeof kCapabilities - 1, nullptr, 16);
  }
  return credentials;
}

std::uint64_t ReadSoftLimit(pid_t tid, const char* name) {
  std::ifstream limits("/proc/" + std::to_string(tid) + "/limits");
  for (std::string line; std::getline(limits, line);) {
    if (!line.starts_with(name)) continue;
    const std::string value = line.substr(strlen(name));
    return value.find_first_not_of(' ') == value.find("unlimited")
               ? RLIM_INFINITY
               : strtoull(value.c_str(), nullptr, 10);
  }
  return 0;
}

SignalSets ReadSignalSets(pid_t tid) {
  char buffer[4096];
  const char* text = ReadStatus(tid, buffer);
  if (text == nullptr) return {};
  const auto set = [&](const char* name) {
    const char* found = strstr(text, name);
    return found == nullptr ? 0 : strtoull(found + strlen(name), nullptr, 16);
  };
  return {.caught = set("\nSigCgt:"),
          .ignored = set("\nSigIgn:"),
          .blocked = set("\nSigBlk:"),
          .own_pending = set("\nSigPnd:"),
          .shared_pending = set("\nShdPnd:")};
}

void SendTimerSignal(const TimerSignalRequest& request) {
  // The kernel lets one process send this code to another.
  static_assert(SI_TIMER < 0);
  siginfo_t info{};
  info.si_signo = request.number;
  info.si_code = SI_TIMER;
  info.si_timerid = request.timer_id;
  info.si_overrun = request.overruns;
  info.si_value.sival_ptr = reinterpret_cast<void*>(request.value);
  if (request.tid == 0) {
    syscall(SYS_rt_sigqueueinfo, request.pid, request.number, &info);
  } else {
    syscall(SYS_rt_tgsigqueueinfo, request.pid, request.tid, request.number, &info);
  }
}

std::string ThreadSystemCall(pid_t tid) {
  std::ifstream file("/proc/" + std::to_string(tid) + "/syscall");
  std::string number;
  return file >> number ? number : "unknown";
}

std::optional<int> DescriptorOfIoctl(pid_t tid) {
  std::ifstream file("/proc/" + std::to_string(tid) + "/syscall");
  long number = -1;
  unsigned long descriptor = 0;
  if (!(file >> number >> std::hex >> descriptor) || number != SYS_ioctl) return std::nullopt;
  return static_cast<int>(descriptor);
}

std::string ProgramOf(pid_t pid) {
  std::error_code gone;
  const auto path = std::filesystem::read_symlink("/proc/" + std::to_string(pid) + "/exe", gone);
  return gone ? "pid " + std::to_string(pid) : path.string();
}

std::vector<pid_t> ThreadsOf(pid_t pid) {
  std::vector<pid_t> tids;
  std::error_code gone;
  // Not a range-for: its steps throw, where the process ends meanwhile.
  std::filesystem::directory_iterator entry("/proc/" + std::to_string(pid) + "/task", gone);
  for (; !gone && entry != std::filesystem::directory_iterator{}; entry.increment(gone)) {
    tids.push_back(std::stoi(entry->path().filename()));
  }
  std::sort(tids.begin(), tids.end());
  return tids;
}

pid_t ProcessOfThread(pid_t tid) {
  char buffer[4096];
  return PidIn(ReadStatus(tid, buffer), "\nTgid:").value_or(-1);
}

pid_t TracerOf(pid_t pid) {
  char buffer[4096];
  return PidIn(ReadStatus(pid, buffer), "\nTracerPid:").value_or(0);
}

bool IsThreadOf(pid_t pid, pid_t tid) {
  char path[64];
  snprintf(path, sizeof path, "/proc/%d/task/%d", pid, tid);
  return access(path, F_OK) == 0;
}

bool DescendsFrom(pid_t pid, pid_t ancestor) {
  while (pid > 1 && pid != ancestor) pid = ParentOf(pid);
  return pid == ancestor;
}

int OpenPidfd(pid_t pid) { return static_cast<int>(syscall(SYS_pidfd_open, pid, 0)); }

int DuplicateFd(int pidfd, int fd) {
  return static_cast<int>(syscall(SYS_pidfd_getfd, pidfd, fd, 0));
}

int WhyNoDuplicates() {
  const UniqueFd own(OpenPidfd(getpid()));
  const UniqueFd copy(own ? DuplicateFd(own.get(), own.get()) : -1);
  return copy ? 0 : errno;
}

// Whoever may not look is told so before the memory is looked for.
int WhyNoLooksInto(pid_t pid) {
  static const char there = 1;
  char found;
  const bool read = ReadMemory(pid, reinterpret_cast<std::uint64_t>(&there), &found, 1);
  return read || errno == EFAULT ? 0 : errno;
}

std::vector<pid_t> ChildrenOf(pid_t pid) {
  std::vector<pid_t> children;
  for (const pid_t tid : ThreadsOf(pid)) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/task/" + std::to_string(tid) +
                       "/children");
    for (pid_t child = 0; file >> child;) children.push_back(child);
  }
  return children;
}

void SendToGate(pid_t pid, pid_t tid, std::uint64_t dispatch) {
  siginfo_t info{};
  info.si_signo = shm::kPreemptionSignal;
  info.si_code = SI_QUEUE;
  info.si_pid = getpid();
  info.si_value.sival_ptr = reinterpret_cast<void*>(dispatch);
  syscall(SYS_rt_tgsigqueueinfo, pid, tid, shm::kPreemptionSignal, &info);
}

namespace {

// The child's half of the hand-over of its trap: sends the descriptor, or why there is none, and
// waits until the parent has closed its end.
void HandOverTrap(int to_parent, const SpawnRequest& request) {
  const UniqueFd listener(InstallTrap(request.guarded, request.trapped_too));
  // From here on calls are trapped, and nobody takes them yet.
  const long own = shm::kOwnCallMark;
  int error = listener ? 0 : errno;
  const int fd = listener.get();
  PassedMessage message(&error, sizeof error, std::span(&fd, listener ? 1 : 0));
  if (syscall(SYS_sendmsg, to_parent, message.get(), MSG_NOSIGNAL, 0, 0, own) < 0) _exit(127);
  char none;
  while (syscall(SYS_read, to_parent, &none, 1, 0, 0, own) < 0 && errno == EINTR) {
  }
}

// None: errno says why.
UniqueFd TakeOverTrap(int from_child) {
  int error = ECHILD;
  Passed passed = ReceivePassed(from_child, &error, sizeof error, 0);
  errno = error;
  return std::move(passed.fd);
}

}  // namespace

int WhyNoFixedLayout() {
  constexpr unsigned long kTellOnly = 0xffffffff;
  char randomizes = 0;
  std::ifstream("/proc/sys/kernel/randomize_va_space") >> randomizes;
  if (randomizes == '0') return 0;
  const int own = personality(kTellOnly);
  if (own < 0 || personality(static_cast<unsigned>(own) | ADDR_NO_RANDOMIZE) < 0) return errno;
  personality(static_cast<unsigned>(own));
  return 0;
}

Spawned Spawn(const SpawnRequest& request) {
  std::vector<char*> argv;
  for (const std::string& word : request.command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  std::optional<SocketPair> sockets = SocketPair::Make();
  if (!sockets.has_value()) return {};
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid != 0) {
    sockets->theirs.Reset();
    Spawned spawned{pid, {}};
    if (pid > 0) {
      // The child comes this far at our own level; for the rest it waits for its dispatch. The
      // level is set here, not in the child, which next runs when it has been given another one.
      spawned.trap = TakeOverTrap(sockets->ours.get());
      SetLevel(pid, Level::kWaiting);
    }
    return spawned;
  }
  sockets->ours.Reset();
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  RestoreOpenFileLimit();
  if (request.computer != nullptr && !EnterComputer(*request.computer)) {
    Say(std::string(argv[0]) + " cannot be put into its robot's network: " + strerror(errno));
    _exit(127);
  }
  HandOverTrap(sockets->theirs.get(), request);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGINT, SIG_DFL);
  signal(SIGPIPE, SIG_DFL);
  if (request.fixed_layout) personality(ADDR_NO_RANDOMIZE);
  for (const auto& [name, value] : request.environment) {
    setenv(name.c_str(), value.c_str(), 1);
  }
  auto redirect = [](const std::string& path, int to) {
    if (path.empty()) return;
    const UniqueFd fd(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644));
    if (fd) dup2(fd.get(), to);
  };
  redirect(request.log_stdout, 1);
  redirect(request.log_stderr, 2);
  if (!request.log_stdout.empty()) {
    const int null = open("/dev/null", O_RDONLY);
    dup2(null, 0);
    // Not what tcsim has open, nor what it was started with: which numbers a program gets for its
    // own is part of what repeats.
    close_range(3, ~0u, CLOSE_RANGE_CLOEXEC);
  }
  if (!request.working_directory.empty() && chdir(request.working_directory.c_str()) != 0) {
    fprintf(stderr, "tcsim: the working directory %s cannot be entered: %s\n",
            request.working_directory.c_str(), strerror(errno));
    _exit(127);
  }
  execvp(argv[0], argv.data());
  const int error = errno;
  Say(std::string(argv[0]) + " cannot be started: " + strerror(error));
  _exit(error == ENOENT ? 127 : 126);
}

}  // namespace tcs
