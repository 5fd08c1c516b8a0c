// Locks on ranges of a file's bytes, by which processes that know nothing of each other tell each
// other small numbers. A process can ask which process holds which range. The kernel lets go of all
// locks of a process when the process ends, however it ends. The file is opened for reading only,
// so that everybody may lock ranges of a file that is root's, and the locks keep nobody from
// anything.
//
// The locks are the process's (POSIX): forks have none of them, and a process does not see its own.
// No other descriptor of the same file may be closed while locks are held.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/port/unique_fd.h"

namespace tcs {

struct LockedRange {
  std::int64_t first = 0, last = 0;
  pid_t holder = 0;  // 0: in a container that this process does not see
};

class RangeLocks {
 public:
  explicit RangeLocks(const std::string& path);

  // Without the file nothing is locked, and no range is anybody's.
  bool present() const { return fd_.get() >= 0; }
  void Lock(std::int64_t first, std::int64_t last);
  void Unlock(std::int64_t first, std::int64_t last);
  // Other processes' ranges that touch this range; by their first bytes.
  std::vector<LockedRange> OfOthers(std::int64_t first, std::int64_t last) const;

  // Only one process at a time is within: what this process has seen is still true when it locks. A
  // process that was stopped within, or holds the file for other reasons, keeps others out for a
  // second at most.
  class Alone {
   public:
    explicit Alone(const RangeLocks& locks);
    ~Alone();
    Alone(const Alone&) = delete;
    Alone& operator=(const Alone&) = delete;

   private:
    const RangeLocks& locks_;
  };

 private:
  UniqueFd fd_;
};

}  // namespace tcs
