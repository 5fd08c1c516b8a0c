// Says to the coordinator that reads of the cycle counter are the processor's.
#pragma once

#include <cstddef>

#include "shm/layout.h"
#include "shm/machine_code/functions.h"

namespace tcs::preload {

using shm::WhereReads;

struct LeftReads {
  std::size_t count = 0;  // that could not be replaced
  shm::Code first = nullptr;

  void Add(shm::Code read) {
    if (count++ == 0) first = read;
  }
};

// Once for a program; nothing where there are none. The thread may wait for its turn meanwhile.
void TellOfReads(const LeftReads& left, WhereReads where);
bool HasToldOfReads();

}  // namespace tcs::preload
