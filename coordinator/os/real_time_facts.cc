#include "coordinator/os/real_time_facts.h"

#include <errno.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "coordinator/os/pipe.h"
#include "coordinator/port/levels.h"

namespace tcs {

static_assert(kRealTimeNeeded == static_cast<int>(Level::kKernelOnly));

namespace {

// The child's findings, as they pass through a pipe.
struct RealTimeAnswers {
  int error;
  bool reaches_kernel, can_raise_limit;
};

RealTimeAnswers TryRealTime() {
  RealTimeAnswers answers{};
  LeaveRealTime(0);  // a process that already has it may keep it without any right
  // The kernel refuses a call without a parameter as invalid, before it looks at rights. A filter
  // does not see what the parameter points to, and refuses this call like the next one.
  answers.reaches_kernel =
      syscall(SYS_sched_setscheduler, 0, SCHED_FIFO, nullptr) == -1 && errno == EINVAL;
  const sched_param needed{kRealTimeNeeded};
  answers.error = sched_setscheduler(0, SCHED_FIFO, &needed) == 0 ? 0 : errno;
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  limit.rlim_cur = kRealTimeNeeded;
  limit.rlim_max = std::max(limit.rlim_max, limit.rlim_cur);
  answers.can_raise_limit = setrlimit(RLIMIT_RTPRIO, &limit) == 0;
  return answers;
}

RealTimeAnswers TryRealTimeInAChild() {
  RealTimeAnswers answers{.error = EAGAIN, .reaches_kernel = true, .can_raise_limit = false};
  std::optional<Pipe> told = Pipe::Make();
  const pid_t child = told ? fork() : -1;
  if (child == 0) {
    const RealTimeAnswers found = TryRealTime();
    _exit(write(told->write_end.get(), &found, sizeof found) == sizeof found ? 0 : 1);
  }
  if (child < 0) {
    answers.error = errno;
    return answers;
  }
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  told->write_end.Reset();
  RealTimeAnswers found;
  if (read(told->read_end.get(), &found, sizeof found) == sizeof found) answers = found;
  return answers;
}

std::string TextOf(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// A number behind a name in /proc/self/status; 0 if it is not there.
std::uint64_t NumberIn(const std::string& status, const std::string& name, int base) {
  const std::size_t at = status.find("\n" + name + ":");
  return at == std::string::npos
             ? 0
             : std::strtoull(status.c_str() + at + name.size() + 2, nullptr, base);
}

// The first user namespace maps all numbers to themselves.
bool InUserNamespace() {
  std::ifstream map("/proc/self/uid_map");
  unsigned long inside = 0, outside = 0, count = 0;
  constexpr unsigned long kAll = 0xffffffff;
  return (map >> inside >> outside >> count) && (inside != 0 || outside != 0 || count != kAll);
}

std::optional<long> BudgetOf(const std::string& folder) {
  std::ifstream file(folder + "/cpu.rt_runtime_us");
  long budget = 0;
  if (!(file >> budget)) return std::nullopt;
  return budget;
}

std::optional<RealTimeGroup> OwnGroup() {
  const auto place = PlaceOfCpuGroup(TextOf("/proc/self/cgroup"), TextOf("/proc/self/mountinfo"));
  if (!place) return std::nullopt;
  const std::optional<long> budget = BudgetOf(place->folder);
  if (!budget) return std::nullopt;
  RealTimeGroup group{.folder = place->folder, .budget_us = *budget, .with_budget = {}};
  for (std::string above = place->folder; above.size() > place->top.size();) {
    above.resize(above.rfind('/'));
    if (BudgetOf(above).value_or(0) != 0) {
      group.with_budget = above;
      break;
    }
  }
  return group;
}

bool IsInList(const std::string& list, const std::string& item) {
  return ("," + list + ",").find("," + item + ",") != std::string::npos;
}

// The path in a line such as "4:cpu,cpuacct:/docker/1".
std::optional<std::string> PathOfCpuGroup(const std::string& groups) {
  std::stringstream lines(groups);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    if (IsInList(line.substr(first + 1, second - first - 1), "cpu")) return line.substr(second + 1);
  }
  return std::nullopt;
}

}  // namespace

std::optional<GroupPlace> PlaceOfCpuGroup(const std::string& groups, const std::string& mounts) {
  const std::optional<std::string> path = PathOfCpuGroup(groups);
  if (!path) return std::nullopt;
  std::stringstream lines(mounts);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t separator = line.find(" - ");
    if (separator == std::string::npos) continue;
    std::string id, parent, device, root, point, type, source, options;
    std::stringstream(line.substr(0, separator)) >> id >> parent >> device >> root >> point;
    std::stringstream(line.substr(separator + 3)) >> type >> source >> options;
    if (type != "cgroup" || !IsInList(options, "cpu")) continue;
    if (root == "/") return GroupPlace{point, *path == "/" ? point : point + *path};
    // A container sees its own group as the top.
    if (*path == root || *path == "/") return GroupPlace{point, point};
    if (path->starts_with(root + "/")) return GroupPlace{point, point + path->substr(root.size())};
  }
  return std::nullopt;
}

RealTimeFacts AskForRealTime() {
  const RealTimeAnswers answers = TryRealTimeInAChild();
  RealTimeFacts facts{.error = answers.error,
                      .reaches_kernel = answers.reaches_kernel,
                      .can_raise_limit = answers.can_raise_limit};
  const std::string status = TextOf("/proc/self/status");
  facts.is_filtered = NumberIn(status, "Seccomp", 10) != 0;
  facts.has_capability = (NumberIn(status, "CapEff", 16) >> CAP_SYS_NICE & 1) != 0;
  facts.may_get_capability = (NumberIn(status, "CapBnd", 16) >> CAP_SYS_NICE & 1) != 0 &&
                             NumberIn(status, "NoNewPrivs", 10) == 0;
  facts.in_user_namespace = InUserNamespace();
  facts.is_root = geteuid() == 0;
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  facts.limit = limit.rlim_cur;
  facts.group = OwnGroup();
  return facts;
}

}  // namespace tcs
