// The part of an ELF file's head that says how its program is loaded.
#pragma once

#include <optional>
#include <string>

namespace tcs {

struct ElfFile {
  bool is_64_bit = false;
  bool is_x86_64 = false;
  bool is_program = false;  // of a type that can be executed
  // The dynamic loader that the file asks for (PT_INTERP); none: statically linked.
  std::optional<std::string> loader;
};

// Reads the ELF file open at `fd` with positioned reads; none if the file is no ELF file or is
// damaged. The loader is looked for in 64-bit little-endian files only.
[[nodiscard]] std::optional<ElfFile> ReadElfFile(int fd);

}  // namespace tcs
