#include "coordinator/processes/unregistered_children.h"

#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "coordinator/port/pidfds.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/waits.h"

namespace tcs {

namespace {

constexpr HostDuration kTurn = HostDuration::Milliseconds(1);

}  // namespace

void UnregisteredChildren::LookFor(const Process& parent) {
  std::erase_if(untaken_, [](pid_t pid) { return ThreadState(pid) != 'Z'; });
  for (const pid_t pid : ChildrenOf(parent.pid)) {
    if (living_.contains(pid) || untaken_.contains(pid)) continue;
    const bool known = std::any_of(table_.processes().begin(), table_.processes().end(),
                                   [pid](const Process& p) { return p.pid == pid; });
    if (known || table_.IsBroker(pid)) continue;
    UniqueFd pidfd(OpenPidfd(pid));
    if (!pidfd) continue;
    reactor_.Add(pidfd.get(), EPOLLIN, {Tag::kUnregisteredChild, static_cast<std::uint32_t>(pid)});
    living_[pid] = {parent.pid, std::move(pidfd)};
  }
}

Process* UnregisteredChildren::Ended(pid_t pid) {
  const auto found = living_.find(pid);
  if (found == living_.end()) return nullptr;
  const Child child = std::move(found->second);
  reactor_.Remove(child.pidfd.get());
  living_.erase(found);
  // A parent that waits for children of another kind leaves this child there.
  untaken_.insert(pid);
  return table_.LivingProcess(child.parent);
}

bool UnregisteredChildren::LetRunBeside(const Process& parent) {
  LookFor(parent);
  if (!AnyRuns()) return false;
  Pause(kTurn);
  return true;
}

bool UnregisteredChildren::AreOf(const Process& parent) const {
  return std::any_of(living_.begin(), living_.end(),
                     [&](const auto& child) { return child.second.parent == parent.pid; });
}

bool UnregisteredChildren::AnyCounts() const {
  return std::any_of(living_.begin(), living_.end(),
                     [this](const auto& child) { return !unregistered_.IsAstray(child.first); });
}

bool UnregisteredChildren::AnyRuns() const {
  return std::any_of(living_.begin(), living_.end(), [&](const auto& child) {
    if (table_.Living(child.first) != nullptr || unregistered_.IsAstray(child.first)) return false;
    const char state = ThreadState(child.first);
    return state == 'R' || state == 'D';
  });
}

}  // namespace tcs
