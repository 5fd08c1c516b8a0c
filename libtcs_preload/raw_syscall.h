// The one door to the kernel: system calls that no interposer sees.
//
// Returns what the kernel returns: a result, or -errno. Never touches errno. Async-signal-safe.
#pragma once

#include <sys/syscall.h>

namespace tcs::preload {

inline long RawSyscall(long number, long a = 0, long b = 0, long c = 0, long d = 0, long e = 0,
                       long f = 0) {
  long result;
  register long r10 __asm__("r10") = d;
  register long r8 __asm__("r8") = e;
  register long r9 __asm__("r9") = f;
  __asm__ volatile("syscall"
                   : "=a"(result)
                   : "a"(number), "D"(a), "S"(b), "d"(c), "r"(r10), "r"(r8), "r"(r9)
                   : "rcx", "r11", "memory");
  return result;
}

template <class T>
long Arg(T* pointer) {
  return reinterpret_cast<long>(pointer);
}

}  // namespace tcs::preload
