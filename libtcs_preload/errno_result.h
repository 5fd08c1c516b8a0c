// From the kernel's convention to the C library's.
#pragma once

#include <errno.h>

namespace tcs::preload {

inline long ToErrno(long result) {
  if (result < 0 && result > -4096) {
    errno = static_cast<int>(-result);
    return -1;
  }
  return result;
}

inline int Fail(int error) {
  errno = error;
  return -1;
}

}  // namespace tcs::preload
