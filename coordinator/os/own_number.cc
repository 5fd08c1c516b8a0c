#include "coordinator/os/own_number.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

// 0: the namespace cannot be seen.
std::uint64_t NamespaceOf(const char* thread) {
  char path[64];
  snprintf(path, sizeof path, "/proc/%s/ns/pid", thread);
  struct stat status;
  return stat(path, &status) == 0 ? status.st_ino : 0;
}

pid_t ByOwnNumber(const std::vector<pid_t>& of, pid_t number) {
  const auto found = std::find_if(
      of.begin(), of.end(), [number](pid_t one) { return OwnNumberOf(one).number == number; });
  return found == of.end() ? 0 : *found;
}

}  // namespace

OwnNumber OwnNumberOf(pid_t tid) {
  static const std::uint64_t kOurs = NamespaceOf("self");
  const std::string thread = std::to_string(tid);
  const std::uint64_t its = NamespaceOf(thread.c_str());
  if (its == 0 || its == kOurs) return {tid, 0};
  std::ifstream status("/proc/" + thread + "/status");
  for (std::string line; std::getline(status, line);) {
    // From the outermost namespace to its own.
    if (line.rfind("NSpid:", 0) == 0) {
      return {atoi(line.c_str() + line.find_last_of(" \t") + 1), its};
    }
  }
  return {tid, 0};
}

pid_t ThreadByOwnNumber(pid_t pid, pid_t number) { return ByOwnNumber(ThreadsOf(pid), number); }

pid_t ChildByOwnNumber(pid_t pid, pid_t number) { return ByOwnNumber(ChildrenOf(pid), number); }

}  // namespace tcs
