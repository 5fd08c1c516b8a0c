#include "coordinator/calls/call_files.h"

#include <errno.h>
#include <sys/syscall.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "coordinator/os/open_files.h"
#include "coordinator/tasks/remote_descriptor.h"
#include "coordinator/tasks/run_state.h"
#include "shm/layout.h"

namespace tcs {

namespace {

// Threads other than the one that waits can close a descriptor or replace it.
bool CanOthersReplace(const Process& process) {
  return process.threads > 1 || process.has_unregistered_threads;
}

bool IsReplaced(const Task& task, int number, int file) {
  if (const auto means = Means(task.tid, number, file); means.has_value()) return !*means;
  // Where the kernel refuses to say (as kcmp to a container) it takes a second copy to know.
  const UniqueFd copy = CopyOfDescriptor(*task.process, number);
  return copy ? !IsSameFile(copy.get(), file) : errno == EBADF;
}

// Whether each number has to be looked at, for which the kernel takes a microsecond. The kernel
// knows of all that has become of a number; the shim knows what libc's calls have made of it. The
// shim's knowledge is enough for epoll sets, which streams and their like do not close, and for
// polls, whose result it does not touch.
bool MayHaveBeenReplaced(const Task& task) {
  const KeptFiles& kept = *task.kept;
  const DescriptorChanges& now = task.process->changes;
  const bool asks_kernel =
      task.process->broker == nullptr && (kept.is_raw || kept.keep == shm::KeepFiles::kForCall);
  return asks_kernel ? kept.since != now : kept.since.by_calls != now.by_calls;
}

// Empty: no number is replaced.
std::vector<bool> AreReplaced(const Task& task) {
  const KeptFiles& kept = *task.kept;
  if (!MayHaveBeenReplaced(task)) return {};
  std::vector<bool> are_replaced;
  for (std::size_t i = 0; i < kept.files.size(); ++i) {
    are_replaced.push_back(IsReplaced(task, kept.asked[i].fd, kept.files[i].get()));
  }
  const bool any = std::find(are_replaced.begin(), are_replaced.end(), true) != are_replaced.end();
  return any ? are_replaced : std::vector<bool>();
}

}  // namespace

bool CallFiles::Keeps(const Task& task, const awaited::Descriptors& watched) {
  const bool is_kept = watched.keep != shm::KeepFiles::kNot && !watched.fds.empty();
  return is_kept && CanOthersReplace(*task.process);
}

void CallFiles::Keep(Task& task, Wait& wait) {
  auto* watched = wait.As<awaited::Descriptors>();
  if (watched == nullptr || !Keeps(task, *watched)) return;
  task.kept = {.files = std::move(watched->fds),
               .asked = std::move(watched->asked),
               .keep = watched->keep,
               .signals = watched->signals,
               .since = watched->since,
               .is_raw = wait.is_in_trapped_call,
               .deadline = wait.deadline,
               .transfers = watched->transfers,
               .done = watched->done};
}

void CallFiles::Keep(Task& task, int number) {
  if (!CanOthersReplace(*task.process)) return;
  UniqueFd copy = CopyOfDescriptor(*task.process, number);
  if (!copy) return;
  task.kept.emplace();
  task.kept->keep = shm::KeepFiles::kForCall;
  task.kept->since = task.process->changes;
  task.kept->files.push_back(std::move(copy));
  task.kept->asked.push_back({number, 0});
}

void CallFiles::KeepOn(Task& task) {
  if (task.kept.has_value()) task.kept->are_replaced.clear();
}

void CallFiles::LookAtNumbers(Task& task) {
  if (!task.kept.has_value() || task.kept->IsNeeded()) return;
  // After a signal the call begins anew, if at all.
  if (task.reason != shm::WakeReason::kSignal) task.kept->are_replaced = AreReplaced(task);
  if (task.kept->IsNeeded()) {
    task.reply[0] = 1;
  } else {
    task.kept.reset();
  }
}

void CallFiles::NoteTurn(Task& task) {
  DescriptorChanges& changes = task.process->changes;
  ++changes.turns;
  const bool tells = task.slot >= 0 && task.state != TaskState::kDead;
  const std::uint32_t seen = tells ? SlotOf(task).descriptors_changed.load() : ~task.changes_seen;
  if (std::exchange(task.changes_seen, seen) != seen) ++changes.by_calls;
}

bool CallFiles::AsksFor(const TrappedCall& call) {
  return call.number == SYS_futex &&
         (call.args[1] == shm::kTakeFile || call.args[1] == shm::kLeaveFiles);
}

void CallFiles::Answer(Task* task, const TrappedCall& call) {
  if (call.args[1] == shm::kLeaveFiles) {
    if (task != nullptr) task->kept.reset();
    AnswerTrapped(call.listener, call.id, 0);
  } else if (task == nullptr || !task->kept.has_value()) {
    AnswerTrapped(call.listener, call.id, -ENOENT);
  } else {
    AnswerTrappedByFile(call.listener, call.id, task->kept->files.front().get(), false);
  }
}

}  // namespace tcs
