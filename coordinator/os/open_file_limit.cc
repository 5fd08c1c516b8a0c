#include "coordinator/os/open_file_limit.h"

#include <sys/resource.h>

#include <optional>

namespace tcs {

namespace {

std::optional<rlimit> g_files_before;

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

std::string WhyNoFurtherFile() {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  return "this run has " + std::to_string(limit.rlim_cur) +
         " files open, which is the limit, and needs several for each of its processes; raise the "
         "limit (ulimit -n), or start fewer processes";
}

}  // namespace tcs
