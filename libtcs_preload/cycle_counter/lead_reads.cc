#include "libtcs_preload/cycle_counter/lead_reads.h"

#include <string.h>
#include <sys/mman.h>

#include "libtcs_preload/cycle_counter/image_reads.h"
#include "libtcs_preload/cycle_counter/loaded_images.h"
#include "libtcs_preload/cycle_counter/shims_own_time.h"
#include "libtcs_preload/raw_syscall.h"
#include "shm/machine_code/counter_reads.h"

namespace tcs::preload {

namespace {

constexpr long kPage = 4096;

// The images that have been looked through, by their places: an image may be unloaded, and another
// image come to its place. For the thread that has the loader's lock.
class Known {
 public:
  // Calls `look(loaded)` with each new image; `look` returns the stand-ins for the image's reads.
  template <class Look>
  void Update(const r_debug& loader, const Look& look) {
    ++round_;
    std::size_t next = 0;
    for (const link_map* one = loader.r_map; one != nullptr; one = one->l_next) {
      const std::size_t i = Find(*one, next);
      if (i == count_ && count_ < kMost) list_[count_++] = {one->l_addr, one->l_ld, look(*one), 0};
      if (i < count_) list_[i].seen = round_;
      next = i + 1;
    }
    ForgetUnseen();
  }

 private:
  // Images beyond that number are left as they are.
  static constexpr std::size_t kMost = 2048;
  struct One {
    Elf64_Addr base;
    const Elf64_Dyn* dynamic;
    StandInMemory* stand_ins;
    std::uint64_t seen;

    bool Is(const link_map& loaded) const {
      return base == loaded.l_addr && dynamic == loaded.l_ld;
    }
  };

  // The loader's list mostly has the same order. Returns count_ if the image is not known.
  std::size_t Find(const link_map& loaded, std::size_t likely) const {
    if (likely < count_ && list_[likely].Is(loaded)) return likely;
    std::size_t i = 0;
    while (i < count_ && !list_[i].Is(loaded)) ++i;
    return i;
  }

  void ForgetUnseen() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (list_[i].seen == round_) {
        list_[kept++] = list_[i];
      } else {
        Free(list_[i].stand_ins);
      }
    }
    count_ = kept;
  }

  One list_[kMost] = {};
  std::size_t count_ = 0;
  std::uint64_t round_ = 0;
};

Known g_known;
const r_debug* g_loader = nullptr;
shm::Sought g_sought;

void LookThrough(const r_debug& loader) {
  LeftReads left;
  {
    const ShimsOwnTime own_time;
    g_known.Update(loader, [&](const link_map& loaded) -> StandInMemory* {
      return IsOthersCode(loaded) ? ReplaceReads(ImageOf(loader, loaded), g_sought, &left)
                                  : nullptr;
    });
  }
  TellOfReads(left, WhereReads::kInFile);
}

// The loader calls a function that does nothing whenever its list has changed, so that debuggers
// can stop there. The loader has its lock then, and no code of a new image has been executed.
void ListHasChanged() {
  if (g_loader->r_state == r_debug::RT_CONSISTENT) LookThrough(*g_loader);
}

// False where that function is none of those that are known.
bool HearOfChanges(const r_debug& loader) {
  using shm::Code;
  const auto function = reinterpret_cast<Code>(loader.r_brk);
  constexpr std::uint8_t kEndbr[] = {0xf3, 0x0f, 0x1e, 0xfa};
  constexpr std::uint8_t kRet = 0xc3;
  // jmp *0(%rip), and the address.
  struct __attribute__((packed)) Jump {
    std::uint8_t code[6] = {0xff, 0x25, 0, 0, 0, 0};
    void (*to)() = ListHasChanged;
  } const jump;
  if (function == nullptr || reinterpret_cast<std::uintptr_t>(function) % 16 != 0) return false;
  const Code ret =
      memcmp(function, kEndbr, sizeof kEndbr) == 0 ? function + sizeof kEndbr : function;
  const Code end = function + 16;
  if (*ret != kRet || shm::machine_code::PaddingIn({ret + 1, end}).end != end) return false;
  const long page = Arg(function) / kPage * kPage;
  if (RawSyscall(SYS_mprotect, page, kPage, PROT_READ | PROT_WRITE | PROT_EXEC) != 0) return false;
  memcpy(const_cast<std::uint8_t*>(function), &jump, sizeof jump);
  RawSyscall(SYS_mprotect, page, kPage, PROT_READ | PROT_EXEC);
  return true;
}

}  // namespace

void LeadReads(const shm::Sought& sought) {
  if (g_loader != nullptr || (!sought.counter && !sought.pauses)) return;
  g_sought = sought;
  g_loader = LoaderOfProgram();
  if (g_loader == nullptr) return;
  HearOfChanges(*g_loader);
  LookThrough(*g_loader);
}

}  // namespace tcs::preload
