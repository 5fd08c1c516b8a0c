// The information of /proc/self/fdinfo on a descriptor: the members of an epoll set, the signals of
// a signalfd. Async-signal-safe; takes 1.2 KiB of the stack.
#pragma once

#include <fcntl.h>
#include <string.h>

#include <cstddef>
#include <cstdint>

#include "libtcs_preload/descriptor_path.h"
#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

// The lines of /proc/self/fdinfo/FD, which says what a descriptor is, whoever made or copied it.
class FdInfo {
 public:
  explicit FdInfo(int fd) {
    const DescriptorPath path("/proc/self/fdinfo/", fd);
    file_ = RawSyscall(SYS_openat, AT_FDCWD, Arg(path.text), O_RDONLY | O_CLOEXEC);
  }
  ~FdInfo() {
    if (file_ >= 0) RawSyscall(SYS_close, file_);
  }
  FdInfo(const FdInfo&) = delete;
  FdInfo& operator=(const FdInfo&) = delete;

  // The next line, or null; the part of a line that does not fit is cut off.
  const char* Next() {
    std::size_t length = 0;
    for (;; ++at_) {
      if (at_ == filled_) {
        const long got = file_ < 0 ? 0 : RawSyscall(SYS_read, file_, Arg(buffer_), sizeof buffer_);
        if (got <= 0) return nullptr;
        filled_ = static_cast<std::size_t>(got);
        at_ = 0;
      }
      if (buffer_[at_] == '\n') break;
      if (length + 1 < sizeof line_) line_[length++] = buffer_[at_];
    }
    ++at_;
    line_[length] = '\0';
    return line_;
  }

 private:
  long file_;
  std::size_t at_ = 0, filled_ = 0;
  char buffer_[1024], line_[160];
};

// The number after `name` in the line.
inline bool FindNumber(const char* line, const char* name, int base, std::uint64_t* number) {
  const char* c = strstr(line, name);
  if (c == nullptr) return false;
  c += strlen(name);
  while (*c == ' ' || *c == '\t') ++c;
  *number = 0;
  for (;; ++c) {
    int digit;
    if (*c >= '0' && *c <= '9') {
      digit = *c - '0';
    } else if (*c >= 'a' && *c <= 'f') {
      digit = *c - 'a' + 10;
    } else {
      return true;
    }
    if (digit >= base) return true;
    *number = *number * static_cast<std::uint64_t>(base) + static_cast<std::uint64_t>(digit);
  }
}

// A member of an epoll set.
struct EpollMember {
  int fd;
  std::uint32_t events;
  std::uint64_t data;
};

// The next member that `info` tells of; false: there is none.
inline bool NextMember(FdInfo& info, EpollMember* member) {
  while (const char* line = info.Next()) {
    std::uint64_t fd, events;
    if (!FindNumber(line, "tfd:", 10, &fd) || !FindNumber(line, "events:", 16, &events) ||
        !FindNumber(line, "data:", 16, &member->data)) {
      continue;
    }
    member->fd = static_cast<int>(fd);
    member->events = static_cast<std::uint32_t>(events);
    return true;
  }
  return false;
}

}  // namespace tcs::preload
