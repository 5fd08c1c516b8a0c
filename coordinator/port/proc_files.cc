#include "coordinator/port/proc_files.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "coordinator/port/unique_fd.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

constexpr unsigned kExiting = 0x4;  // PF_EXITING

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

// Reads /proc/TID/status: null without it, else `text`.
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
  // Not a range-for: the steps of a range-for throw where the process ends meanwhile.
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

std::vector<pid_t> ChildrenOf(pid_t pid) {
  std::vector<pid_t> children;
  for (const pid_t tid : ThreadsOf(pid)) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/task/" + std::to_string(tid) +
                       "/children");
    for (pid_t child = 0; file >> child;) children.push_back(child);
  }
  return children;
}

}  // namespace tcs
