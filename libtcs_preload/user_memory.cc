#include "libtcs_preload/user_memory.h"

#include <errno.h>
#include <signal.h>
#include <sys/prctl.h>

#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

namespace {

std::uintptr_t Address(const void* pointer) { return reinterpret_cast<std::uintptr_t>(pointer); }

// The kernel reads the set before it finds that it does not know what to do with it. Null would be
// no set.
bool IsReadable(std::uintptr_t address) {
  constexpr long kNoSuchThing = -1;
  constexpr std::uintptr_t kSetSize = 8;
  const std::uintptr_t set = address < kSetSize ? kSetSize : address / kSetSize * kSetSize;
  return RawSyscall(SYS_rt_sigprocmask, kNoSuchThing, static_cast<long>(set), 0, kSetSize) !=
         -EFAULT;
}

// The kernel writes an int there.
bool IsWritable(std::uintptr_t address) {
  return RawSyscall(SYS_prctl, PR_GET_PDEATHSIG, static_cast<long>(address)) != -EFAULT;
}

// `is_there(address)` for a place in each page of the range.
template <class IsThere>
bool EachPage(std::uintptr_t start, std::size_t size, IsThere is_there) {
  const std::uintptr_t end = start + size;
  if (end < start) return false;
  for (std::uintptr_t at = start; at < end; at = (at / kPageSize + 1) * kPageSize) {
    if (!is_there(at)) return false;
  }
  return true;
}

// Strings lie next to each other: a page that was just found to be there is not asked for again.
class Reader {
 public:
  bool Has(const void* from, std::size_t size) {
    return EachPage(Address(from), size, [this](std::uintptr_t at) {
      if (at / kPageSize == page_) return true;
      if (!IsReadable(at)) return false;
      page_ = at / kPageSize;
      return true;
    });
  }

 private:
  std::uintptr_t page_ = ~std::uintptr_t{0};  // none yet
};

}  // namespace

bool CanReadFar(const void* from, std::size_t size) {
  return EachPage(Address(from), size, IsReadable);
}

bool CanOverwriteFar(void* to, std::size_t size) {
  const std::uintptr_t start = Address(to), end = start + size;
  return EachPage(start, size, [end](std::uintptr_t at) {
    // At the end of the range the int is the last one in it.
    return IsWritable(end - at < sizeof(int) ? end - sizeof(int) : at);
  });
}

bool CanReadStrings(const char* const* list) {
  Reader pointers, strings;
  for (; list != nullptr; ++list) {
    if (!pointers.Has(list, sizeof *list)) return false;
    if (*list == nullptr) return true;
    for (const char* c = *list;; ++c) {
      if (!strings.Has(c, 1)) return false;
      if (*c == '\0') break;
    }
  }
  return true;
}

}  // namespace tcs::preload
