#include "coordinator/calls/last_descriptor.h"

#include <errno.h>
#include <fmt/format.h>
#include <sys/syscall.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "shm/last_descriptor.h"

namespace tcs {

namespace {

// The text that /proc shows for the descriptor: for a socket its number, which no other socket has.
std::string FileOf(const std::filesystem::path& descriptor) {
  std::error_code gone;
  return std::filesystem::read_symlink(descriptor, gone).string();
}

int DescriptorsOf(pid_t pid, const std::string& file) {
  int count = 0;
  std::error_code gone;
  // Not a range-for: the steps of a range-for throw where the process ends meanwhile.
  std::filesystem::directory_iterator entry(fmt::format("/proc/{}/fd", pid), gone);
  for (; !gone && entry != std::filesystem::directory_iterator{}; entry.increment(gone)) {
    if (FileOf(entry->path()) == file) ++count;
  }
  return count;
}

}  // namespace

bool LastDescriptor::AsksFor(const TrappedCall& call) {
  return call.number == SYS_futex && call.args[1] == shm::kIsLastDescriptor;
}

void LastDescriptor::Answer(const RunState& run, const Task* task, const TrappedCall& call) {
  if (task == nullptr) {
    AnswerTrapped(call.listener, call.id, -ENOSYS);
    return;
  }
  const auto fd = static_cast<int>(call.args[2]);
  const std::string file = FileOf(fmt::format("/proc/{}/fd/{}", task->process->pid, fd));
  int count = 0;
  for (const Process& process : run.table.processes()) {
    if (!process.dead && count < 2) count += DescriptorsOf(process.pid, file);
  }
  AnswerTrapped(call.listener, call.id, count < 2 ? 1 : 0);
}

}  // namespace tcs
