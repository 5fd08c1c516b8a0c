// Values in a client's memory, and times in them.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstdint>

#include "coordinator/port/traps.h"
#include "coordinator/tasks/task.h"
#include "shm/time_values.h"

namespace tcs {

using shm::IsValid;
using shm::ToNs;
using shm::ToTimespec;

// False where the client has no such memory.
template <class T>
bool Read(const Task& task, std::uint64_t address, T* to) {
  return ReadMemory(task.process->pid, address, to, sizeof *to);
}

template <class T>
bool Write(const Task& task, std::uint64_t address, const T& value) {
  return WriteMemory(task.process->pid, address, &value, sizeof value);
}

// The time as a timeout: one that is too far off is for less than ever, but for more than any run
// lasts.
inline std::int64_t ToTimeoutNs(const timespec& t) { return std::min(ToNs(t), shm::kFarNs); }

}  // namespace tcs
