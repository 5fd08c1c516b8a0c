#include "libtcs_preload/random.h"

#include <errno.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/random.h>
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
