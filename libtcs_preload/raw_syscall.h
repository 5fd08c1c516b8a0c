// The one door to the kernel: system calls that no interposer sees, and that the trap lets through.
//
// Returns what the kernel returns: a result, or -errno. Never touches errno. Async-signal-safe.
#pragma once

#include <sys/syscall.h>

#include "shm/layout.h"

namespace tcs::preload {

#ifdef TCS_SIMULATED_HOST
// The simulated host's door (tests/simulate/).
long RawSyscall(long number, long a, long b, long c, long d, long e, long f);
#else
// With all six arguments. Calls of this form must not be among the calls that the trap lets through
// by the mark.
inline long RawSyscall(long number, long a, long b, long c, long d, long e, long f) {
  long result;
  register long r10 __asm__("r10") = d;
  register long r8 __asm__("r8") = e;
  register long r9 __asm__("r9") = f;
  // r9 is cleared: the C library's own calls leave it as they find it, and a mark is not theirs.
  __asm__ volatile(
      "syscall\n\t"
      "xor %%r9d, %%r9d"
      : "=a"(result), "+r"(r9)
      : "a"(number), "D"(a), "S"(b), "d"(c), "r"(r10), "r"(r8)
      : "rcx", "r11", "memory", "cc");
  return result;
}
#endif

// In the last argument, in the mark's place: the call is handed to the coordinator.
inline constexpr long kTrapped = 0;

inline long RawSyscall(long number, long a = 0, long b = 0, long c = 0, long d = 0, long e = 0) {
  return RawSyscall(number, a, b, c, d, e, static_cast<long>(shm::kOwnCallMark));
}

// recvfrom and sendto, which use all of their arguments: the mark is in that half of the flags
// which the kernel does not look at.
inline long RawSocketCall(long number, int fd, long buffer, std::size_t size, int flags,
                          long address, long address_size) {
  const std::uint64_t marked =
      std::uint64_t{shm::kOwnCallMark} << 32 | static_cast<std::uint32_t>(flags);
  return RawSyscall(number, fd, buffer, static_cast<long>(size), static_cast<long>(marked), address,
                    address_size);
}

template <class T>
long Arg(T* pointer) {
  return reinterpret_cast<long>(pointer);
}

}  // namespace tcs::preload
