#include "coordinator/scenario/elf_file.h"

#include <elf.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>

namespace tcs {
namespace {

constexpr std::size_t kLongestLoaderPath = 4096;

bool ReadAt(int fd, void* into, std::size_t size, std::uint64_t offset) {
  if (offset > INT64_MAX) return false;
  return pread(fd, into, size, static_cast<off_t>(offset)) == static_cast<ssize_t>(size);
}

}  // namespace

std::optional<ElfFile> ReadElfFile(int fd) {
  unsigned char ident[EI_NIDENT];
  if (!ReadAt(fd, ident, sizeof ident, 0) || std::memcmp(ident, ELFMAG, SELFMAG) != 0) {
    return std::nullopt;
  }
  ElfFile file;
  file.is_64_bit = ident[EI_CLASS] == ELFCLASS64;
  if (!file.is_64_bit) return file;
  if (ident[EI_DATA] != ELFDATA2LSB) return file;

  Elf64_Ehdr header;
  if (!ReadAt(fd, &header, sizeof header, 0)) return std::nullopt;
  file.is_x86_64 = header.e_machine == EM_X86_64;
  file.is_program = header.e_type == ET_EXEC || header.e_type == ET_DYN;
  if (!file.is_x86_64 || !file.is_program) return file;
  if (header.e_phentsize != sizeof(Elf64_Phdr)) return std::nullopt;

  for (unsigned i = 0; i < header.e_phnum; ++i) {
    Elf64_Phdr segment;
    if (!ReadAt(fd, &segment, sizeof segment, header.e_phoff + i * sizeof segment)) {
      return std::nullopt;
    }
    if (segment.p_type != PT_INTERP) continue;
    if (segment.p_filesz == 0 || segment.p_filesz > kLongestLoaderPath) return std::nullopt;
    std::string loader(segment.p_filesz, '\0');
    if (!ReadAt(fd, loader.data(), loader.size(), segment.p_offset)) return std::nullopt;
    loader.resize(std::strlen(loader.c_str()));
    file.loader = std::move(loader);
    break;
  }
  return file;
}

}  // namespace tcs
