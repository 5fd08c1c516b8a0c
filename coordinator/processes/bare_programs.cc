#include "coordinator/processes/bare_programs.h"

#include <fcntl.h>
#include <sys/auxv.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "coordinator/os/auxiliary_vector.h"
#include "coordinator/os/host.h"
#include "coordinator/os/unique_fd.h"
#include "coordinator/os/vdso_calls.h"
#include "coordinator/scenario/elf_file.h"

namespace tcs {

namespace {

bool IsOfMusl(const std::string& executable) {
  const UniqueFd file(open(executable.c_str(), O_RDONLY | O_CLOEXEC));
  const auto elf = ReadElfFile(file.get());
  return elf.has_value() && elf->loader.has_value() &&
         elf->loader->find("ld-musl") != std::string::npos;
}

}  // namespace

void BarePrograms::Begins(pid_t pid) {
  const std::string executable = "/proc/" + std::to_string(pid) + "/exe";
  std::error_code unreadable;
  const std::string name = std::filesystem::read_symlink(executable, unreadable).string();
  const auto told = ReadAuxiliaryVector(pid);
  const auto loader = told.find(AT_BASE);
  if (loader != told.end() && loader->second != 0) {
    if (!IsOfMusl(executable)) return;
    run_.Warn(
        name +
        " is linked against musl, whose loader refuses tcs's library, so it ends at once; tcs "
        "runs programs of the GNU C library: rebuild it against that, or statically");
    return;
  }
  Process* process = run_.table.LivingProcess(pid);
  if (process != nullptr) {
    process->is_bare = true;
  } else {
    std::erase_if(unknown_, [](pid_t one) { return ThreadState(one) == 'X'; });
    unknown_.insert(pid);
  }
  if (Task* first = run_.table.Living(pid); first != nullptr) {
    first->end_word = 0;  // that of the program before
    first->can_be_stopped = false;
  }
  if (process != nullptr && !process->patch_vdso) return;
  if (MakeVdsoCall(pid)) return;
  run_.Warn(name +
            " is statically linked, and the kernel does not let tcs lead its clocks, so they show "
            "the host's time; link it dynamically (without -static or -static-pie)");
}

}  // namespace tcs
