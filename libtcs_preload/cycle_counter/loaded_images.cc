#include "libtcs_preload/cycle_counter/loaded_images.h"

#include <string.h>
#include <sys/auxv.h>

#include "libtcs_preload/user_memory.h"

namespace tcs::preload {

namespace {

using shm::Code;
using shm::Image;

const Elf64_Phdr* ProgramsSegments() {
  return reinterpret_cast<const Elf64_Phdr*>(getauxval(AT_PHDR));
}

bool StartsWith(const char* text, const char* start) {
  return strncmp(text, start, strlen(start)) == 0;
}

}  // namespace

const r_debug* LoaderOfProgram() {
  Image program{nullptr, ProgramsSegments(), getauxval(AT_PHNUM)};
  if (program.segments == nullptr) return nullptr;
  const Elf64_Phdr* itself = program.Segment(PT_PHDR);
  if (itself != nullptr) {
    program.base = reinterpret_cast<Code>(program.segments) - itself->p_vaddr;
  }
  const Elf64_Phdr* dynamic = program.Segment(PT_DYNAMIC);
  if (dynamic == nullptr) return nullptr;
  const auto* entry = reinterpret_cast<const Elf64_Dyn*>(program.At(dynamic->p_vaddr));
  for (; entry->d_tag != DT_NULL; ++entry) {
    if (entry->d_tag == DT_DEBUG) return reinterpret_cast<const r_debug*>(entry->d_un.d_ptr);
  }
  return nullptr;
}

Image ImageOf(const r_debug& loader, const link_map& loaded) {
  Image image;
  image.base = reinterpret_cast<Code>(loaded.l_addr);
  if (&loaded == loader.r_map) {
    image.segments = ProgramsSegments();
    image.count = getauxval(AT_PHNUM);
    return image;
  }
  // At the begin of a library is its header, and behind that are its segments.
  const auto* header = reinterpret_cast<const Elf64_Ehdr*>(image.base);
  if (!CanRead(header, kPageSize) || memcmp(header->e_ident, ELFMAG, SELFMAG) != 0 ||
      header->e_phentsize != sizeof(Elf64_Phdr) ||
      header->e_phoff + header->e_phnum * sizeof(Elf64_Phdr) > kPageSize) {
    return image;
  }
  Image found = image;
  found.segments = reinterpret_cast<const Elf64_Phdr*>(image.base + header->e_phoff);
  found.count = header->e_phnum;
  const Elf64_Phdr* dynamic = found.Segment(PT_DYNAMIC);
  const bool is_it =
      dynamic != nullptr && found.At(dynamic->p_vaddr) == reinterpret_cast<Code>(loaded.l_ld);
  return is_it ? found : image;
}

bool IsOthersCode(const link_map& loaded) {
  const char* slash = strrchr(loaded.l_name, '/');
  const char* name = slash == nullptr ? loaded.l_name : slash + 1;
  const auto base = static_cast<unsigned long>(loaded.l_addr);
  return base != getauxval(AT_BASE) && base != getauxval(AT_SYSINFO_EHDR) &&
         !StartsWith(name, "libtcs_") && !StartsWith(name, "ld-linux") &&
         !StartsWith(name, "libc.so.");
}

}  // namespace tcs::preload
