#include "libtcs_preload/random.h"

#include <errno.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/random.h>
#include <sys/stat.h>

#include "libtcs_preload/clock_calls.h"
#include "libtcs_preload/descriptor_path.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/memory_devices.h"
#include "libtcs_preload/raw_syscall.h"
#include "shm/draws.h"

using namespace tcs::preload;
using tcs::shm::kUuidFile;

namespace {

tcs::shm::Draws g_draws;
bool g_seeded = false;

bool IsUuidFile(int fd) {
  const DescriptorPath link("/proc/self/fd/", fd);
  char name[sizeof kUuidFile];
  return RawSyscall(SYS_readlink, Arg(link.text), Arg(name), sizeof name) == sizeof kUuidFile - 1 &&
         memcmp(name, kUuidFile, sizeof kUuidFile - 1) == 0;
}

}  // namespace

namespace tcs::preload {

void SeedProcess(const shm::ThreadSlot& slot) {
  if (g_header->accounting != shm::Accounting::kFixed || slot.pid != slot.tid) return;
  g_draws.Seed(slot.seed);
  g_seeded = true;
  if (auto* at_random = reinterpret_cast<void*>(getauxval(AT_RANDOM)); at_random != nullptr) {
    g_draws.Fill(at_random, 16);
  }
}

bool DrawsRepeat() { return g_seeded; }

void RepeatDraws(int fd, const iovec* buffers, std::size_t count, ssize_t size) {
  struct stat status;
  if (size <= 0 || !g_seeded || RawSyscall(SYS_fstat, fd, Arg(&status)) != 0) return;
  const bool are_bytes = shm::IsRandomDevice(status);
  if (!are_bytes && (!shm::MayBeUuidFile(status) || !IsUuidFile(fd))) return;
  const auto whole = static_cast<std::size_t>(size);
  std::size_t done = 0;
  for (std::size_t i = 0; i < count && done < whole; ++i) {
    const std::size_t left = whole - done;
    const std::size_t n = buffers[i].iov_len < left ? buffers[i].iov_len : left;
    if (are_bytes) {
      g_draws.Fill(buffers[i].iov_base, n);
    } else {
      shm::DrawUuid(g_draws, static_cast<char*>(buffers[i].iov_base), n, done);
    }
    done += n;
  }
}

long GetRandom(void* buffer, std::size_t size, unsigned flags) {
  const bool repeats = Enter() != nullptr && g_seeded;
  const auto draw = [flags](void* to, std::size_t n) {
    return RawSyscall(SYS_getrandom, Arg(to), static_cast<long>(n), flags);
  };
  // The kernel judges the arguments, and fills what it can.
  const long filled = Completed(buffer, size, draw(buffer, size), draw);
  if (repeats && filled > 0) g_draws.Fill(buffer, static_cast<std::size_t>(filled));
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
