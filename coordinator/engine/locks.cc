#include "coordinator/engine/locks.h"

#include <sys/epoll.h>

#include "coordinator/os/mutex_owner.h"

namespace tcs {

namespace {

bool WaitsForRoom(const Task& task) {
  if (task.Awaits<awaited::Room>() != nullptr) return true;
  if (task.Awaits<awaited::Descriptors>() == nullptr) return false;
  const shm::Notification& note = SlotOf(task).note;
  const bool says_so = !task.wait->is_in_trapped_call && note.fd_count == 1;
  return says_so && (note.fds[0].events & (EPOLLIN | EPOLLOUT)) == EPOLLOUT;
}

}  // namespace

const Task* OwnerOfAwaitedLock(const Task& task, const RunState& run, const FutexTable& futexes) {
  const auto* futex = task.Awaits<awaited::Futex>();
  if (futex == nullptr) return nullptr;
  if (futex->owner != awaited::kNobody) return &run.table.At(futex->owner);
  const FutexKey* word = futexes.FirstWordOf(task.order);
  if (word == nullptr || word->pid == 0) return nullptr;
  const auto owner = OwnerOfMutex(task.process->pid, word->address, [&](pid_t tid) {
    const Task* one = run.table.Living(tid);
    return one != nullptr && one->process == task.process;
  });
  return owner.has_value() ? run.table.Living(*owner) : nullptr;
}

std::optional<AnswerBook::Pause> PauseOf(const Task& task, const RunState& run,
                                         const FutexTable& futexes, const AnswerFeed& answers) {
  using For = AnswerBook::Pause::For;
  if (WaitsForRoom(task)) return AnswerBook::Pause{.what = For::kRoom};
  const Task* owner = OwnerOfAwaitedLock(task, run, futexes);
  if (owner == nullptr) return std::nullopt;
  const auto who = answers.WhoIs(*owner);
  return AnswerBook::Pause{.what = For::kLock, .client = who.has_value() ? who->client : -1};
}

}  // namespace tcs
