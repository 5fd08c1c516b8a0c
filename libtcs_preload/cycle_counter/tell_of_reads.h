// Says to the coordinator that reads of the cycle counter are the processor's.
#pragma once

#include <cstddef>

#include "shm/layout.h"
#include "shm/machine_code/functions.h"

namespace tcs::preload {

using shm::WhereReads;

struct LeftReads {
  std::size_t count = 0;  // reads that could not be replaced
  shm::Code first = nullptr;

  void Add(shm::Code read) {
    if (count++ == 0) first = read;
  }
};

// Tells once for a program; tells nothing where no reads are left. The thread may wait for its turn
// meanwhile.
void TellOfReads(const LeftReads& left, WhereReads where);
bool HasToldOfReads();

}  // namespace tcs::preload
