// The code that reads of the cycle counter, and pauses, are led to: for each of them in an image
// some bytes, near enough to the image for a jump, which call entries.h, or spinning/pauses.h, and
// go on behind the read or pause.
#pragma once

#include "shm/machine_code/stand_in.h"

namespace tcs::preload {

// Memory of stand-ins. It says itself how long it is and where the next memory of the same image
// is.
struct StandInMemory;

// Frees the stand-ins of an image that has been unloaded: no thread may be in its code any more.
void Free(StandInMemory* first);

// Memory with room for the code of so many reads of the image. Written once, by the thread that has
// made it, and executed from Finish on. Stays until Free.
class StandIns {
 public:
  // False from is_there() where the kernel gives no memory that is near enough.
  StandIns(shm::CodeRange image, std::size_t reads, const shm::Sought& sought);

  bool is_there() const { return memory_ != nullptr; }
  // The code for this read; null: the read's instructions cannot be moved as far.
  shm::Code Add(const shm::Replacement& replacement);
  // False if the kernel lets none of the code be executed. The memory is the first of the list
  // then.
  bool Finish(StandInMemory** list);

 private:
  const shm::Sought sought_;
  StandInMemory* memory_ = nullptr;
  std::size_t size_ = 0, used_ = 0;
};

}  // namespace tcs::preload
