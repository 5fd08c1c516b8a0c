#include "coordinator/os/vdso_calls.h"

#include <dlfcn.h>
#include <elf.h>
#include <fcntl.h>
#include <sys/auxv.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "coordinator/os/auxiliary_vector.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {

namespace {

// xor r9d, r9d (an argument that these calls do not have, and that marks the shim's own ones);
// mov eax, the number; syscall; ret.
using MachineCode = std::array<std::uint8_t, 11>;

MachineCode CodeOf(std::uint32_t number) {
  MachineCode code{0x45, 0x31, 0xc9, 0xb8, 0, 0, 0, 0, 0x0f, 0x05, 0xc3};
  memcpy(&code[4], &number, sizeof number);
  return code;
}

struct Function {
  const char* name;
  std::uint32_t number;
};

constexpr Function kFunctions[] = {{"__vdso_clock_gettime", SYS_clock_gettime},
                                   {"__vdso_gettimeofday", SYS_gettimeofday},
                                   {"__vdso_time", SYS_time},
                                   {"__vdso_getcpu", SYS_getcpu}};

}  // namespace

bool MakeVdsoCall(pid_t pid) {
  const std::uint64_t base = ReadAuxiliaryVector(pid)[AT_SYSINFO_EHDR];
  if (base == 0) return true;  // the process has no vDSO
  const UniqueFd memory(
      open(("/proc/" + std::to_string(pid) + "/mem").c_str(), O_RDWR | O_CLOEXEC));
  // All processes have the same vDSO, at an address of their own.
  static void* const ours = dlopen("linux-vdso.so.1", RTLD_LAZY | RTLD_LOCAL | RTLD_NOLOAD);
  if (memory.get() < 0 || ours == nullptr) return false;
  for (const Function& function : kFunctions) {
    const void* at = dlsym(ours, function.name);
    if (at == nullptr) continue;
    const std::uint64_t offset = reinterpret_cast<std::uintptr_t>(at) - getauxval(AT_SYSINFO_EHDR);
    const MachineCode code = CodeOf(function.number);
    if (pwrite(memory.get(), code.data(), code.size(), static_cast<off_t>(base + offset)) !=
        static_cast<ssize_t>(code.size())) {
      return false;
    }
  }
  return true;
}

}  // namespace tcs
