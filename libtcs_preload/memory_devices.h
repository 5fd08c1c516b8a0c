// /dev/zero, /dev/urandom and their kin, and the kernel's random numbers: the bytes that a program
// asks them for are always there.
//
// Async-signal-safe.
#pragma once

#include <sys/stat.h>

#include <cstddef>

#include "libtcs_preload/pieces.h"

namespace tcs::preload {

// The kernel's log (kmsg) is none: a read of the log waits for more.
bool IsMemoryDevice(const struct stat& status);
bool IsMemoryDevice(int fd);

// After a page the kernel ends such a read where a signal is pending. tcs's own signals, of which
// no program knows, must not be seen by that.
inline bool MayBeCutShort(long got, std::size_t size) {
  constexpr long kPageSize = 4096;
  const std::size_t most = size < kMostBytes ? size : kMostBytes;
  return got > 0 && got % kPageSize == 0 && static_cast<std::size_t>(got) < most;
}

// Reads all that was asked for, of which the first `got` bytes are there. `read(from, size)` reads
// on.
template <class Read>
long Completed(void* buffer, std::size_t size, long got, Read read) {
  while (MayBeCutShort(got, size)) {
    const long more = read(static_cast<char*>(buffer) + got, size - static_cast<std::size_t>(got));
    if (more <= 0) break;
    got += more;
  }
  return got;
}

}  // namespace tcs::preload
