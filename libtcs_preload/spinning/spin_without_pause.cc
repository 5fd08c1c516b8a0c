#include "libtcs_preload/cycle_counter/shims_own_time.h"
#include "libtcs_preload/spinning/pauses.h"
#include "libtcs_preload/user_memory.h"
#include "shm/machine_code/spin_loop.h"

namespace tcs::preload {

namespace {

// Remembers where it has looked: loops are short.
class ReadableCode {
 public:
  bool operator()(shm::Code at, std::size_t size) const {
    const auto begin = reinterpret_cast<std::uintptr_t>(at), end = begin + size;
    if (known_begin_ <= begin && end <= known_end_) return true;
    const std::uintptr_t first = begin / kPageSize * kPageSize;
    const std::uintptr_t pages = (end - first + kPageSize - 1) / kPageSize;
    if (!CanRead(reinterpret_cast<const void*>(first), pages * kPageSize)) return false;
    known_begin_ = first;
    known_end_ = first + pages * kPageSize;
    return true;
  }

 private:
  mutable std::uintptr_t known_begin_ = 0, known_end_ = 0;
};

}  // namespace

void NoteWhetherInLoop(GuestThread& thread, std::uintptr_t at) {
  const ShimsOwnTime own_time;
  const bool is_in_loop = shm::IsInSpinLoop(reinterpret_cast<shm::Code>(at), ReadableCode());
  thread.slot->spin.in_loop = is_in_loop ? 1 : 0;
}

}  // namespace tcs::preload
