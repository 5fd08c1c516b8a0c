#include "libtcs_preload/cycle_counter/lead_reads.h"

#include <string.h>
#include <sys/mman.h>

#include "libtcs_preload/cycle_counter/image_reads.h"
#include "libtcs_preload/cycle_counter/loaded_images.h"
#include "libtcs_preload/cycle_counter/shims_own_time.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/raw_syscall.h"
#include "shm/machine_code/counter_reads.h"

namespace tcs::preload {

namespace {

constexpr long kPage = 4096;

// The images that have been looked through, by their places: one may be unloaded, and another one
// come to its place. For the thread that has the loader's lock.
class Known {
 public:
  bool Has(const link_map& loaded) const {
    for (std::size_t i = 0; i < count_; ++i) {
      if (list_[i].base == loaded.l_addr && list_[i].dynamic == loaded.l_ld) return true;
    }
    return false;
  }

  void Add(const link_map& loaded) {
    if (count_ < kMost) list_[count_++] = {loaded.l_addr, loaded.l_ld};
  }

  // Only what is in the loader's list still.
  void Keep(const r_debug& loader) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      for (const link_map* one = loader.r_map; one != nullptr; one = one->l_next) {
        if (one->l_addr != list_[i].base || one->l_ld != list_[i].dynamic) continue;
        list_[kept++] = list_[i];
        break;
      }
    }
    count_ = kept;
  }

 private:
  // More are looked through each time that something is loaded.
  static constexpr std::size_t kMost = 2048;
  struct One {
    Elf64_Addr base;
    const Elf64_Dyn* dynamic;
  };
  One list_[kMost] = {};
  std::size_t count_ = 0;
};

Known g_known;
const r_debug* g_loader = nullptr;

void TellOf(const LeftReads& left) {
  static bool told = false;
  GuestThread* thread = IfAttached();
  if (left.count == 0 || told || thread == nullptr) return;
  told = true;
  Exchange(*thread, Request{.kind = shm::NotificationKind::kCounterReads,
                            .args = {static_cast<std::int64_t>(left.count),
                                     reinterpret_cast<std::int64_t>(left.first)}});
}

void LookThrough(const r_debug& loader) {
  LeftReads left;
  {
    const ShimsOwnTime own_time;
    g_known.Keep(loader);
    for (const link_map* one = loader.r_map; one != nullptr; one = one->l_next) {
      if (g_known.Has(*one)) continue;
      g_known.Add(*one);
      if (IsOthersCode(*one)) ReplaceReads(ImageOf(loader, *one), &left);
    }
  }
  TellOf(left);
}

// The loader calls a function that does nothing whenever its list has changed, so that debuggers
// can stop there. It has its lock then, and no code of what is new has been executed.
void ListHasChanged() {
  if (g_loader->r_state == r_debug::RT_CONSISTENT) LookThrough(*g_loader);
}

// False where that function is another one than all known ones.
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

void LeadCounterReads() {
  if (g_loader != nullptr) return;
  g_loader = LoaderOfProgram();
  if (g_loader == nullptr) return;
  HearOfChanges(*g_loader);
  LookThrough(*g_loader);
}

}  // namespace tcs::preload
