// The buffer of a call, as a list of one.
#pragma once

#include <sys/uio.h>

#include <cstddef>
#include <cstdint>

namespace tcs::preload {

inline constexpr std::size_t kMostBuffers = 1024;  // above it the kernel says EINVAL

// The kernel moves no more than this in a call (MAX_RW_COUNT). Of a buffer by itself it takes no
// notice of what is beyond, where in a list (sendmsg) it would say EINVAL.
inline constexpr std::size_t kMostBytes = 0x7fff'f000;
inline iovec PieceOf(const void* buffer, std::size_t size) {
  return {const_cast<void*>(buffer), size < kMostBytes ? size : kMostBytes};
}

// But read and write fail at once where not all of the buffer could be the program's.
inline bool IsBeyondMemory(const void* buffer, std::size_t size) {
  constexpr std::uintptr_t kEnd = std::uintptr_t{1} << 47;
  const auto begin = reinterpret_cast<std::uintptr_t>(buffer);
  return begin > kEnd || size > kEnd - begin;
}

}  // namespace tcs::preload
