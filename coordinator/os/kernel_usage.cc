#include "coordinator/os/kernel_usage.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fstream>
#include <iterator>
#include <string>

#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

struct Faults {
  long long own_minor = 0, children_minor = 0, own_major = 0, children_major = 0;
  long long user = 0, system = 0, children_user = 0, children_system = 0;
};

std::string ProcFolder(pid_t pid) { return "/proc/" + std::to_string(pid); }

std::string WholeFile(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

Faults ReadStat(const std::string& folder) {
  const std::string text = WholeFile(folder + "/stat");
  // The name may hold anything; the state follows its last parenthesis.
  const std::size_t end = text.rfind(')');
  Faults read;
  if (end == std::string::npos) return read;
  sscanf(text.c_str() + end + 1,
         " %*c %*d %*d %*d %*d %*d %*u %lld %lld %lld %lld %lld %lld %lld %lld", &read.own_minor,
         &read.children_minor, &read.own_major, &read.children_major, &read.user, &read.system,
         &read.children_user, &read.children_system);
  return read;
}

std::int64_t Number(const std::string& status, const char* name) {
  const std::size_t at = status.find(name);
  return at == std::string::npos ? 0 : strtoll(status.c_str() + at + strlen(name), nullptr, 10);
}

void AddSwitches(const std::string& folder, KernelUsage& usage) {
  const std::string status = WholeFile(folder + "/status");
  usage.waits += Number(status, "\nvoluntary_ctxt_switches:");
  usage.preemptions += Number(status, "\nnonvoluntary_ctxt_switches:");
}

KernelUsage UsageIn(const std::string& folder) {
  const Faults stat = ReadStat(folder);
  return {.user_ticks = stat.user,
          .system_ticks = stat.system,
          .minor_faults = stat.own_minor,
          .major_faults = stat.own_major,
          .peak_kib = Number(WholeFile(folder + "/status"), "\nVmHWM:")};
}

}  // namespace

KernelUsage KernelUsageOfProcess(pid_t pid) {
  const std::string folder = ProcFolder(pid);
  KernelUsage usage = UsageIn(folder);
  for (const pid_t tid : ThreadsOf(pid))
    AddSwitches(folder + "/task/" + std::to_string(tid), usage);
  return usage;
}

KernelUsage KernelUsageOfThread(pid_t pid, pid_t tid) {
  const std::string folder = ProcFolder(pid) + "/task/" + std::to_string(tid);
  KernelUsage usage = UsageIn(folder);
  AddSwitches(folder, usage);
  return usage;
}

KernelUsage KernelUsageOfChildren(pid_t pid) {
  const Faults stat = ReadStat(ProcFolder(pid));
  return {.user_ticks = stat.children_user,
          .system_ticks = stat.children_system,
          .minor_faults = stat.children_minor,
          .major_faults = stat.children_major};
}

}  // namespace tcs
