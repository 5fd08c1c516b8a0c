#include "coordinator/processes/bare_programs.h"

#include <fcntl.h>
#include <sys/auxv.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>

#include "coordinator/os/auxiliary_vector.h"
#include "coordinator/os/vdso_calls.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"
#include "coordinator/port/unique_fd.h"
#include "coordinator/processes/counter_reads.h"
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
    first->end_word = 0;  // the end word of the program before
    first->can_be_stopped = false;
  }
  if (run_.IsFixed()) RepeatKernelsDraws(pid, told);
  LeadClocks(pid, process, name);
  LeadCounter(pid, process, name);
}

// As the shim does for other programs. Whether the process is known by now must not show: one
// sequence is for all processes.
void BarePrograms::RepeatKernelsDraws(pid_t pid,
                                      const std::map<std::uint64_t, std::uint64_t>& told) {
  const auto at = told.find(AT_RANDOM);
  if (at == told.end()) return;
  std::array<std::uint8_t, 16> drawn{};
  draws_.Fill(drawn.data(), drawn.size());
  WriteMemory(pid, at->second, drawn.data(), drawn.size());
}

void BarePrograms::LeadClocks(pid_t pid, const Process* process, const std::string& name) {
  if (process != nullptr && !process->patch_vdso) return;
  if (MakeVdsoCall(pid)) return;
  run_.Warn(name +
            " is statically linked, and the kernel does not let tcs lead its clocks, so they show "
            "the host's time; link it dynamically (without -static or -static-pie)");
}

void BarePrograms::LeadCounter(pid_t pid, const Process* process, const std::string& name) {
  if (process != nullptr && !process->leads_counter) return;
  const std::string executable = "/proc/" + std::to_string(pid) + "/exe";
  struct stat file {};
  if (stat(executable.c_str(), &file) != 0) return;
  const FileKey key{file.st_dev, file.st_ino,
                    file.st_mtim.tv_sec * 1'000'000'000 + file.st_mtim.tv_nsec, file.st_size};
  auto known = counter_patches_.find(key);
  if (known == counter_patches_.end()) {
    known =
        counter_patches_.emplace(key, PatchesOf(executable, run_.header->counter_ticks_per_ns_q32))
            .first;
  }
  std::uint64_t first_left = 0;
  if (!WritePatches(pid, known->second, &first_left)) {
    run_.Warn(name +
              " reads the processor's cycle counter (rdtsc), which shows the host's time, for the "
              "kernel does not let tcs change the program; link it dynamically (without -static "
              "or -static-pie)");
  } else if (first_left != 0 && process != nullptr) {
    WarnOfCounterReads(
        run_, *process,
        {.places = static_cast<std::int64_t>(known->second.left.size()), .first = first_left});
  }
}

}  // namespace tcs
