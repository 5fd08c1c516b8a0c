// The code that reads of the cycle counter, and pauses, are led to: for each of an image some
// bytes, near enough to it for a jump, which call entries.h, or spinning/pauses.h, and go on behind
// it.
#pragma once

#include "shm/machine_code/stand_in.h"

namespace tcs::preload {

// Memory of stand-ins, which says itself how long it is and where the next one's of the same image
// is.
struct StandInMemory;

// Of an image that has been unloaded: no thread may be in its code any more.
void Free(StandInMemory* first);

// Where code for so many reads of the image has room. Written once, by the thread that has made it,
// and executed from Finish on. Stays until Free.
class StandIns {
 public:
  // False from is_there() where the kernel gives no memory that is near enough.
  StandIns(shm::CodeRange image, std::size_t reads, const shm::Sought& sought);

  bool is_there() const { return memory_ != nullptr; }
  // The code for this read; null: its instructions cannot be moved as far.
  shm::Code Add(const shm::Replacement& replacement);
  // False if the kernel lets nothing of it be executed. The memory is the first of the list then.
  bool Finish(StandInMemory** list);

 private:
  const shm::Sought sought_;
  StandInMemory* memory_ = nullptr;
  std::size_t size_ = 0, used_ = 0;
};

}  // namespace tcs::preload
