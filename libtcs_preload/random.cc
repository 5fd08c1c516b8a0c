#include "libtcs_preload/random.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <atomic>

#include "libtcs_preload/clock_calls.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"

using namespace tcs::preload;

namespace {

std::atomic<std::uint64_t> g_state{0};
bool g_seeded = false;

// splitmix64: the state is a counter, so that a handler that draws between two draws does no harm.
std::uint64_t Next() {
  std::uint64_t z = g_state.fetch_add(0x9e3779b97f4a7c15) + 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

void Fill(void* buffer, std::size_t size) {
  auto* out = static_cast<char*>(buffer);
  while (size > 0) {
    const std::uint64_t word = Next();
    const std::size_t n = size < sizeof word ? size : sizeof word;
    memcpy(out, &word, n);
    out += n;
    size -= n;
  }
}

// The kernel's devices for that: /dev/random and /dev/urandom.
bool IsRandomDevice(int fd) {
  struct stat status;
  return RawSyscall(SYS_fstat, fd, Arg(&status)) == 0 && S_ISCHR(status.st_mode) &&
         (status.st_rdev == makedev(1, 8) || status.st_rdev == makedev(1, 9));
}

constexpr std::size_t kBytesOfStream = 1 << 20;

// -1 if the kernel does not give the memory.
long FileOfDraws() {
  const long fd = RawSyscall(SYS_memfd_create, Arg("random"), MFD_CLOEXEC);
  if (fd < 0) return fd;
  char draws[4096];
  for (std::size_t done = 0; done < kBytesOfStream; done += sizeof draws) {
    Fill(draws, sizeof draws);
    if (RawSyscall(SYS_pwrite64, fd, Arg(draws), sizeof draws, static_cast<long>(done)) !=
        sizeof draws) {
      RawSyscall(SYS_close, fd);
      return -1;
    }
  }
  return fd;
}

}  // namespace

namespace tcs::preload {

void SeedProcess(const shm::ThreadSlot& slot) {
  if (g_header->accounting != shm::Accounting::kFixed || slot.pid != slot.tid) return;
  g_state.store(slot.seed);
  g_seeded = true;
  if (auto* at_random = reinterpret_cast<void*>(getauxval(AT_RANDOM)); at_random != nullptr) {
    Fill(at_random, 16);
  }
}

bool DrawsRepeat() { return g_seeded; }

void RepeatDraws(int fd, const iovec* buffers, std::size_t count, ssize_t size) {
  if (size <= 0 || !g_seeded || !IsRandomDevice(fd)) return;
  auto left = static_cast<std::size_t>(size);
  for (std::size_t i = 0; i < count && left > 0; ++i) {
    const std::size_t n = buffers[i].iov_len < left ? buffers[i].iov_len : left;
    Fill(buffers[i].iov_base, n);
    left -= n;
  }
}

FILE* RepeatDraws(FILE* stream) {
  if (stream == nullptr || !g_seeded || !IsRandomDevice(fileno(stream))) return stream;
  const long draws = FileOfDraws();
  if (draws < 0) return stream;
  const long flags = RawSyscall(SYS_fcntl, fileno(stream), F_GETFD);
  RawSyscall(SYS_dup3, draws, fileno(stream), flags == FD_CLOEXEC ? O_CLOEXEC : 0);
  RawSyscall(SYS_close, draws);
  return stream;
}

long GetRandom(void* buffer, std::size_t size, unsigned flags) {
  if (Enter() == nullptr || !g_seeded) {
    return RawSyscall(SYS_getrandom, Arg(buffer), static_cast<long>(size), flags);
  }
  // The kernel judges the arguments, and fills what it can.
  const long filled = RawSyscall(SYS_getrandom, Arg(buffer), static_cast<long>(size), flags);
  if (filled > 0) Fill(buffer, static_cast<std::size_t>(filled));
  return filled;
}

}  // namespace tcs::preload

TCS_EXPORT ssize_t getrandom(void* buffer, std::size_t size, unsigned flags) {
  return ToErrno(GetRandom(buffer, size, flags));
}

TCS_EXPORT int getentropy(void* buffer, std::size_t size) {
  if (size > 256) return Fail(EIO);
  return getrandom(buffer, size, 0) == static_cast<ssize_t>(size) ? 0 : -1;
}

TCS_EXPORT void arc4random_buf(void* buffer, std::size_t size) noexcept {
  auto* out = static_cast<char*>(buffer);
  while (size > 0) {
    const long n = GetRandom(out, size < 256 ? size : 256, 0);
    if (n == -EFAULT) __builtin_trap();  // as the C library's: there is no such memory
    if (n <= 0) continue;
    out += n;
    size -= static_cast<std::size_t>(n);
  }
}

TCS_EXPORT std::uint32_t arc4random(void) noexcept {
  std::uint32_t word;
  arc4random_buf(&word, sizeof word);
  return word;
}

TCS_EXPORT std::uint32_t arc4random_uniform(std::uint32_t bound) noexcept {
  if (bound < 2) return 0;
  const std::uint32_t least = -bound % bound;
  for (;;) {
    const std::uint32_t word = arc4random();
    if (word >= least) return word % bound;
  }
}
