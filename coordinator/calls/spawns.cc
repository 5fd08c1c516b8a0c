#include "coordinator/calls/spawns.h"

#include <unistd.h>

#include "coordinator/os/host.h"

namespace tcs {

void Spawns::Handle(Task& maker, const shm::Notification& note) {
  if (note.args[0] == 0) {
    OfThread(maker, note);
  } else {
    OfProcess(maker, static_cast<pid_t>(note.args[0]));
  }
}

void Spawns::OfThread(Task& creator, const shm::Notification& note) {
  for (const pid_t tid : ThreadsOf(creator.process->pid)) {
    if (run_.table.Living(tid) != nullptr || unmanaged_.IsLowered(tid)) continue;
    executor_.Hold(tid);
    Task& thread = births_.AddThread(*creator.process, tid, creator.reached);
    scheduling_.Inherit(thread, creator);
    if (note.args[1] >= 0) scheduling_.SetPriority(creator, thread, note.args[1], note.args[2]);
    if (note.args[3] != 0)
      scheduling_.SetAffinity(creator, thread, static_cast<std::uint64_t>(note.args[3]));
  }
}

// Only a child of its own: with CLONE_PARENT its parent's. It has not been waited for, so that its
// number is nobody else's.
void Spawns::OfProcess(Task& parent, pid_t pid) {
  Process& of = *parent.process;
  if (pid <= 0 || run_.table.LivingProcess(pid) != nullptr || run_.table.Living(pid) != nullptr)
    return;
  if (ThreadState(pid) == 'X' || ThreadState(pid) == 'Z') return;
  const pid_t actual = ParentOf(pid);
  if (actual != of.pid && (actual != of.parent || actual == getpid())) return;
  executor_.Hold(pid);
  scheduling_.Inherit(births_.AddChild(pid, of.pid, of, parent.reached), parent);
}

}  // namespace tcs
