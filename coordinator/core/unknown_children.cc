// Children of a bare clone, or of the system call itself, that make no call that tcs knows: nobody
// has announced them, and they do not register. Their parent learns of their end, and time waits
// while they run.
#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"

namespace tcs {

namespace {

constexpr int kYieldsBeforeLook = 100;
constexpr useconds_t kStrangersTurnUs = 1'000;

}  // namespace

// When a thread comes to wait for its children.
void Engine::FindUnknownChildren(Process& parent) {
  std::erase_if(untaken_children_, [](pid_t pid) { return ThreadState(pid) != 'Z'; });
  for (const pid_t pid : ChildrenOf(parent.pid)) {
    if (unknown_children_.contains(pid) || untaken_children_.contains(pid)) continue;
    const bool known = std::any_of(table_.processes().begin(), table_.processes().end(),
                                   [pid](const Process& p) { return p.pid == pid; });
    if (known) continue;
    UniqueFd pidfd(OpenPidfd(pid));
    if (!pidfd) continue;
    reactor_.Add(pidfd.get(), EPOLLIN, {Tag::kUnknownChild, static_cast<std::uint32_t>(pid)});
    unknown_children_[pid] = {parent.pid, std::move(pidfd)};
  }
}

void Engine::UnknownChildEnded(pid_t pid, Moment moment) {
  const auto found = unknown_children_.find(pid);
  if (found == unknown_children_.end()) return;
  const UnknownChild child = std::move(found->second);
  reactor_.Remove(child.pidfd.get());
  unknown_children_.erase(found);
  // A parent that waits for children of another kind leaves it there.
  untaken_children_.insert(pid);
  Process* parent = LivingProcess(child.parent);
  if (parent != nullptr) stops_.ChildChanged(*parent, pid, false, moment);
}

bool Engine::HasUnknownChild(const Process& parent) const {
  return std::any_of(unknown_children_.begin(), unknown_children_.end(),
                     [&](const auto& child) { return child.second.parent == parent.pid; });
}

// Equals have their turn. Whoever yields again and again may wait for a process that shares its
// memory and never registers (a sanitizer's that looks for leaks): it gets real time to run in.
bool Engine::Yield(Task& task) {
  SchedulerOf(task).Yield(task.order);
  if (++task.yields < kYieldsBeforeLook) return false;
  task.yields = 0;
  FindUnknownChildren(*task.process);
  if (!UnknownChildrenRun()) return false;
  usleep(kStrangersTurnUs);
  return true;
}

bool Engine::AwaitsUnknownChildren() const {
  return std::any_of(unknown_children_.begin(), unknown_children_.end(),
                     [this](const auto& child) { return !IsAstray(child.first); });
}

bool Engine::UnknownChildrenRun() const {
  return std::any_of(unknown_children_.begin(), unknown_children_.end(), [&](const auto& child) {
    if (KnownTask(child.first) != nullptr || IsAstray(child.first)) return false;
    const char state = ThreadState(child.first);
    return state == 'R' || state == 'D';
  });
}

}  // namespace tcs
