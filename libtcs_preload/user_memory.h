// The program's memory, as a system call takes it: memory that cannot be read or written is an
// error of the call (EFAULT) and not the end of the program.
//
// Only the kernel knows whether memory is there, and asking it takes a system call for each page.
// Memory in the page of the caller's stack frame needs no question, and a program mostly has there
// what it hands over. Async-signal-safe; errno stays as it is.
#pragma once

#include <string.h>

#include <cstddef>
#include <cstdint>

namespace tcs::preload {

inline constexpr std::uintptr_t kPageSize = 4096;

bool CanReadFar(const void* from, std::size_t size);
bool CanOverwriteFar(void* to, std::size_t size);

// True for memory in the page of the stack that this function is called on.
inline bool IsNear(const void* start, std::size_t size) {
  const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
  const std::uintptr_t offset =
      reinterpret_cast<std::uintptr_t>(start) - here / kPageSize * kPageSize;
  return offset < kPageSize && size <= kPageSize - offset;
}

inline bool CanRead(const void* from, std::size_t size) {
  return __builtin_expect(IsNear(from, size), 1) || CanReadFar(from, size);
}

// May change the memory: for memory that is about to be written as a whole. At least 4 bytes, or
// none.
inline bool CanOverwrite(void* to, std::size_t size) {
  return __builtin_expect(IsNear(to, size), 1) || CanOverwriteFar(to, size);
}

// A list of strings that ends with a null pointer, as execve takes it; null is such a list, too.
bool CanReadStrings(const char* const* list);

// False: EFAULT.
template <class T>
bool CopyIn(T* to, const T* from) {
  if (!CanRead(from, sizeof *from)) return false;
  memcpy(static_cast<void*>(to), from, sizeof *to);
  return true;
}
template <class T>
bool CopyOut(T* to, const T& from) {
  static_assert(sizeof from >= sizeof(int));
  if (!CanOverwrite(to, sizeof *to)) return false;
  memcpy(static_cast<void*>(to), &from, sizeof from);
  return true;
}

}  // namespace tcs::preload
