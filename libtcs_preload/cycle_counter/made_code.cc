// Code that a program makes at run time. Where such code reads the cycle counter, the read cannot
// be replaced, because the code's functions are not known: the coordinator is told of it.
#include <sys/mman.h>
#include <sys/uio.h>

#include "libtcs_preload/cycle_counter/tell_of_reads.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "shm/machine_code/counter_reads.h"

using namespace tcs::preload;
using tcs::shm::Code;
using tcs::shm::CodeRange;

namespace {

// Code is looked through piece by piece, as copies: not all of the mapped memory can be read.
constexpr std::size_t kPiece = 64 << 10, kOverlap = 64;
// A program that makes more memory executable at once reserves room for code to come.
constexpr std::size_t kMostSize = 16 << 20;

void LookThrough(Code start, std::size_t size, std::uint8_t* copy, LeftReads* left) {
  for (std::size_t done = 0; done < size; done += kPiece - kOverlap) {
    const iovec to{copy, kPiece};
    const iovec from{const_cast<std::uint8_t*>(start) + done,
                     size - done < kPiece ? size - done : kPiece};
    const long read =
        RawSyscall(SYS_process_vm_readv, RawSyscall(SYS_getpid), Arg(&to), 1, Arg(&from), 1, 0);
    if (read <= 0) return;
    const CodeRange code{copy, copy + read};
    tcs::shm::ForEachLookingLikeARead(code, {}, [&](Code at) {
      if (tcs::shm::TakesUpCounter(code, at)) left->Add(start + done + (at - copy));
    });
  }
}

LeftReads ReadsIn(Code start, std::size_t size) {
  LeftReads left;
  const long copy =
      RawSyscall(SYS_mmap, 0, kPiece, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (copy < 0 && copy > -4096) return left;
  LookThrough(start, size, reinterpret_cast<std::uint8_t*>(copy), &left);
  RawSyscall(SYS_munmap, copy, kPiece);
  return left;
}

bool IsToBeLookedThrough(std::size_t size, int protection) {
  constexpr int kWanted = PROT_READ | PROT_EXEC;
  const GuestThread* t = IfAttached();
  return (protection & kWanted) == kWanted && size <= kMostSize && t != nullptr &&
         t->slot->leads_counter != 0 && !HasToldOfReads();
}

}  // namespace

// The kernel's. Async-signal-safe.
TCS_EXPORT int mprotect(void* start, std::size_t size, int protection) noexcept {
  const long result = RawSyscall(SYS_mprotect, Arg(start), static_cast<long>(size), protection);
  if (result == 0 && IsToBeLookedThrough(size, protection)) {
    TellOfReads(ReadsIn(static_cast<Code>(start), size), WhereReads::kInMadeCode);
  }
  return static_cast<int>(ToErrno(result));
}
