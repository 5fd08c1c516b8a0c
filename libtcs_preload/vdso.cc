#include "libtcs_preload/vdso.h"

#include <elf.h>
#include <errno.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/mman.h>

#include <cstddef>
#include <cstdint>

#include "libtcs_preload/clock_calls.h"
#include "libtcs_preload/random.h"
#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

namespace {

// The kernel's answer about a generator's state to a caller that asks with this size. Our generator
// needs none.
constexpr std::size_t kAskForState = ~std::size_t{0};
struct RandomState {
  std::uint32_t size, mmap_prot, mmap_flags, reserved[13];
};

// As the vDSO's functions report: a result or a negative errno.
int VdsoClockGettime(clockid_t id, timespec* ts) { return static_cast<int>(ClockGettime(id, ts)); }
int VdsoGettimeofday(timeval* tv, void* zone) { return static_cast<int>(Gettimeofday(tv, zone)); }
int VdsoClockGetres(clockid_t id, timespec* ts) { return static_cast<int>(ClockGetres(id, ts)); }
int VdsoGetcpu(unsigned* cpu, unsigned* node, void*) { return static_cast<int>(GetCpu(cpu, node)); }

long VdsoGetrandom(void* buffer, std::size_t size, unsigned flags, void* state,
                   std::size_t state_size) {
  if (state_size != kAskForState) return GetRandom(buffer, size, flags);
  const RandomState needed{64, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, {}};
  memcpy(state, &needed, sizeof needed);
  return 0;
}

struct Replacement {
  const char* name;
  const void* function;
};

// jmp *0(%rip), and the address.
struct __attribute__((packed)) Jump {
  std::uint8_t code[6] = {0xff, 0x25, 0, 0, 0, 0};
  const void* to;
};

struct Image {
  const char* base = nullptr;
  std::uint64_t offset = 0;  // to be added to an address in the image
  std::uint64_t size = 0;
  const Elf64_Sym* symbols = nullptr;
  const char* names = nullptr;
  std::uint32_t symbol_count = 0;
};

// The count of symbols stands in the old hash table; where there is only the new one, its last
// chain ends with the last symbol.
std::uint32_t CountInGnuHash(const std::uint32_t* table) {
  const std::uint32_t buckets = table[0], first = table[1], bloom_words = table[2];
  const std::uint32_t* bucket = table + 4 + bloom_words * 2;
  const std::uint32_t* chains = bucket + buckets;
  std::uint32_t last = 0;
  for (std::uint32_t i = 0; i < buckets; ++i) last = bucket[i] > last ? bucket[i] : last;
  if (last < first) return first;
  while ((chains[last - first] & 1) == 0) ++last;
  return last + 1;
}

Image Parse(const char* base) {
  Image image;
  const auto* header = reinterpret_cast<const Elf64_Ehdr*>(base);
  const auto* segment = reinterpret_cast<const Elf64_Phdr*>(base + header->e_phoff);
  const Elf64_Dyn* dynamic = nullptr;
  for (int i = 0; i < header->e_phnum; ++i, ++segment) {
    if (segment->p_type == PT_LOAD) {
      image.offset = reinterpret_cast<std::uint64_t>(base) + segment->p_offset - segment->p_vaddr;
      image.size = segment->p_offset + segment->p_memsz;
    }
    if (segment->p_type == PT_DYNAMIC) {
      dynamic = reinterpret_cast<const Elf64_Dyn*>(base + segment->p_offset);
    }
  }
  if (dynamic == nullptr) return image;
  for (; dynamic->d_tag != DT_NULL; ++dynamic) {
    const auto* at = reinterpret_cast<const char*>(image.offset + dynamic->d_un.d_ptr);
    if (dynamic->d_tag == DT_SYMTAB) image.symbols = reinterpret_cast<const Elf64_Sym*>(at);
    if (dynamic->d_tag == DT_STRTAB) image.names = at;
    const auto* words = reinterpret_cast<const std::uint32_t*>(at);
    if (dynamic->d_tag == DT_HASH) image.symbol_count = words[1];
    if (dynamic->d_tag == DT_GNU_HASH && image.symbol_count == 0) {
      image.symbol_count = CountInGnuHash(words);
    }
  }
  image.base = base;
  return image;
}

const Elf64_Sym* Find(const Image& image, const char* name) {
  for (std::uint32_t i = 0; i < image.symbol_count; ++i) {
    const Elf64_Sym& symbol = image.symbols[i];
    if (symbol.st_shndx == SHN_UNDEF || symbol.st_size < sizeof(Jump)) continue;
    if (strcmp(image.names + symbol.st_name, name) == 0) return &symbol;
  }
  return nullptr;
}

// As a whole: the kernel does not split this mapping.
bool Protect(const Image& image, int protection) {
  constexpr std::uint64_t kPage = 4096;
  const auto size = static_cast<long>((image.size + kPage - 1) / kPage * kPage);
  return RawSyscall(SYS_mprotect, Arg(image.base), size, protection) == 0;
}

void Replace(const Image& image, const Replacement& replacement) {
  const Elf64_Sym* symbol = Find(image, replacement.name);
  if (symbol == nullptr) return;
  const Jump jump{.to = replacement.function};
  memcpy(reinterpret_cast<void*>(image.offset + symbol->st_value), &jump, sizeof jump);
}

}  // namespace

void PatchVdso() {
  static bool patched;
  const auto* base = reinterpret_cast<const char*>(getauxval(AT_SYSINFO_EHDR));
  if (patched || base == nullptr) return;
  patched = true;
  const Image image = Parse(base);
  if (image.base == nullptr || image.symbols == nullptr || image.names == nullptr) return;
  if (!Protect(image, PROT_READ | PROT_WRITE | PROT_EXEC)) return;
  const Replacement replacements[] = {
      {"__vdso_clock_gettime", reinterpret_cast<const void*>(VdsoClockGettime)},
      {"__vdso_gettimeofday", reinterpret_cast<const void*>(VdsoGettimeofday)},
      {"__vdso_time", reinterpret_cast<const void*>(Time)},
      {"__vdso_clock_getres", reinterpret_cast<const void*>(VdsoClockGetres)},
      {"__vdso_getcpu", reinterpret_cast<const void*>(VdsoGetcpu)},
  };
  for (const Replacement& replacement : replacements) Replace(image, replacement);
  // Where draws need not repeat, the kernel's own function is left alone: that one is faster.
  if (DrawsRepeat()) {
    Replace(image, {"__vdso_getrandom", reinterpret_cast<const void*>(VdsoGetrandom)});
  }
  Protect(image, PROT_READ | PROT_EXEC);
}

}  // namespace tcs::preload
