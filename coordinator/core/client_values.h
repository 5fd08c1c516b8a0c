// Values in a client's memory, and the C library's forms of time in them.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstdint>

#include "coordinator/core/task.h"
#include "coordinator/os/trap.h"

namespace tcs {

inline constexpr std::int64_t kNsPerSecond = 1'000'000'000;

// False where the client has no such memory.
template <class T>
bool Read(const Task& task, std::uint64_t address, T* to) {
  return ReadMemory(task.process->pid, address, to, sizeof *to);
}

template <class T>
bool Write(const Task& task, std::uint64_t address, const T& value) {
  return WriteMemory(task.process->pid, address, &value, sizeof value);
}

// What is too far off is taken for less, but for more than any run lasts.
inline std::int64_t ToNs(const timespec& t) {
  constexpr std::int64_t kMostSeconds = shm::kNeverNs / kNsPerSecond / 4;
  return std::min<std::int64_t>(t.tv_sec, kMostSeconds) * kNsPerSecond + t.tv_nsec;
}

inline timespec ToTimespec(std::int64_t ns) { return {ns / kNsPerSecond, ns % kNsPerSecond}; }

inline bool IsValid(const timespec& t) {
  return t.tv_sec >= 0 && t.tv_nsec >= 0 && t.tv_nsec < kNsPerSecond;
}

}  // namespace tcs
