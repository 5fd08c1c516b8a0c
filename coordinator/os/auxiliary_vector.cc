#include "coordinator/os/auxiliary_vector.h"

#include <elf.h>
#include <fcntl.h>
#include <unistd.h>

#include <string>

#include "coordinator/port/unique_fd.h"

namespace tcs {

std::map<std::uint64_t, std::uint64_t> ReadAuxiliaryVector(pid_t pid) {
  std::map<std::uint64_t, std::uint64_t> vector;
  const UniqueFd file(
      open(("/proc/" + std::to_string(pid) + "/auxv").c_str(), O_RDONLY | O_CLOEXEC));
  Elf64_auxv_t entry{};
  while (read(file.get(), &entry, sizeof entry) == static_cast<ssize_t>(sizeof entry) &&
         entry.a_type != AT_NULL) {
    vector[entry.a_type] = entry.a_un.a_val;
  }
  return vector;
}

}  // namespace tcs
