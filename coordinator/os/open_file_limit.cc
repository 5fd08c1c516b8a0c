#include "coordinator/os/open_file_limit.h"

#include <sys/resource.h>

#include <algorithm>
#include <optional>

namespace tcs {

namespace {

std::optional<rlimit> g_files_before;

// How many files no process is given. Of a small limit a quarter, so that some process is followed
// at all.
constexpr rlim_t kForTheEnd = 32;

rlim_t MostFiles() {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  return limit.rlim_cur;
}

}  // namespace

void RaiseOpenFileLimit() {
  rlimit limit;
  if (g_files_before.has_value() || getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  g_files_before = limit;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

void RestoreOpenFileLimit() {
  if (g_files_before.has_value()) setrlimit(RLIMIT_NOFILE, &*g_files_before);
}

// The kernel gives the least number that is free.
bool IsAmongLastFiles(int fd) {
  const rlim_t most = MostFiles();
  return static_cast<rlim_t>(fd) + std::min(kForTheEnd, most / 4) >= most;
}

std::string WhyNoFurtherFile() {
  return "this run may have " + std::to_string(MostFiles()) +
         " files open, and needs several for each of its processes; raise the limit (ulimit -n), "
         "or start fewer processes";
}

}  // namespace tcs
