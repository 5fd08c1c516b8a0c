// Reads at a place in a file. Such reads wait for nothing, and are the kernel's but for random
// numbers.
#include <pthread.h>
#include <sys/types.h>
#include <sys/uio.h>

#include <cstddef>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/random.h"
#include "libtcs_preload/raw_syscall.h"

using namespace tcs::preload;

namespace {

ssize_t ReadPlaced(int fd, void* buffer, std::size_t size, off_t at) {
  pthread_testcancel();
  const long got = RawSyscall(SYS_pread64, fd, Arg(buffer), static_cast<long>(size), at);
  const iovec whole{buffer, size};
  RepeatDraws(fd, &whole, 1, got);
  return ToErrno(got);
}

ssize_t ReadPlaced(int fd, const iovec* buffers, int count, off_t at) {
  pthread_testcancel();
  const long got = RawSyscall(SYS_preadv, fd, Arg(buffers), count, at);
  RepeatDraws(fd, buffers, static_cast<std::size_t>(count), got);
  return ToErrno(got);
}

}  // namespace

TCS_EXPORT ssize_t pread(int fd, void* buffer, std::size_t size, off_t at) {
  return ReadPlaced(fd, buffer, size, at);
}
TCS_EXPORT ssize_t pread64(int fd, void* buffer, std::size_t size, off_t at) {
  return ReadPlaced(fd, buffer, size, at);
}
TCS_EXPORT ssize_t __pread64(int fd, void* buffer, std::size_t size, off_t at) {
  return ReadPlaced(fd, buffer, size, at);
}
TCS_EXPORT ssize_t __pread_chk(int fd, void* buffer, std::size_t size, off_t at, std::size_t room) {
  if (size > room) __builtin_trap();
  return ReadPlaced(fd, buffer, size, at);
}
TCS_EXPORT ssize_t __pread64_chk(int fd, void* buffer, std::size_t size, off_t at,
                                 std::size_t room) {
  if (size > room) __builtin_trap();
  return ReadPlaced(fd, buffer, size, at);
}

TCS_EXPORT ssize_t preadv(int fd, const iovec* buffers, int count, off_t at) {
  return ReadPlaced(fd, buffers, count, at);
}
TCS_EXPORT ssize_t preadv64(int fd, const iovec* buffers, int count, off_t at) {
  return ReadPlaced(fd, buffers, count, at);
}
