// A program or library as it lies in memory, by its program headers.
//
// Pure; async-signal-safe.
#pragma once

#include <elf.h>

#include "shm/machine_code/functions.h"

namespace tcs::shm {

struct Image {
  Code base = nullptr;  // added to an address in the file, it gives the one in memory
  const Elf64_Phdr* segments = nullptr;
  std::size_t count = 0;

  Code At(std::uint64_t address) const { return base + address; }

  // Calls `found` with the code of each segment that can be executed and read, and its header.
  template <class Found>
  void ForEachCode(const Found& found) const {
    for (std::size_t i = 0; i < count; ++i) {
      const Elf64_Phdr& one = segments[i];
      constexpr unsigned kWanted = PF_R | PF_X;
      if (one.p_type != PT_LOAD || (one.p_flags & kWanted) != kWanted) continue;
      found(CodeRange{At(one.p_vaddr), At(one.p_vaddr + one.p_filesz)}, one);
    }
  }

  // The range from the first to the last segment; its parts between segments may not be readable.
  CodeRange Whole() const {
    CodeRange whole;
    for (std::size_t i = 0; i < count; ++i) {
      const Elf64_Phdr& one = segments[i];
      if (one.p_type != PT_LOAD) continue;
      if (whole.begin == nullptr) whole.begin = At(one.p_vaddr);
      whole.end = At(one.p_vaddr + one.p_memsz);
    }
    return whole;
  }

  const Elf64_Phdr* Segment(std::uint32_t type) const {
    for (std::size_t i = 0; i < count; ++i) {
      if (segments[i].p_type == type) return segments + i;
    }
    return nullptr;
  }

  // Of the segment that the table for unwinding lies in, all of which is in the file.
  UnwindTable Functions() const {
    const Elf64_Phdr* table = Segment(PT_GNU_EH_FRAME);
    if (table == nullptr) return {};
    for (std::size_t i = 0; i < count; ++i) {
      const Elf64_Phdr& one = segments[i];
      if (one.p_type != PT_LOAD || (one.p_flags & PF_R) == 0 || table->p_vaddr < one.p_vaddr ||
          table->p_vaddr >= one.p_vaddr + one.p_filesz) {
        continue;
      }
      return UnwindTable(At(table->p_vaddr), {At(one.p_vaddr), At(one.p_vaddr + one.p_filesz)},
                         Whole());
    }
    return {};
  }
};

}  // namespace tcs::shm
