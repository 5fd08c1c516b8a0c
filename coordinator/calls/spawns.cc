#include "coordinator/calls/spawns.h"

#include <unistd.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "coordinator/os/own_number.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"

namespace tcs {

namespace {

// Of creations of which a program says that it will tell, and never does.
constexpr std::size_t kMostCreations = 64;

// A child that acts in its parent's place. A child of a program without the shim does not: nothing
// of the parent's is in it but the memory.
bool ActsForParent(const Task& maker, const CloneCall& call) {
  return call.SharesMemory() && call.WaitsForChild() && !maker.process->is_bare;
}

}  // namespace

bool Spawns::IsAnnounced(const Task& maker) {
  return maker.slot >= 0 && SlotOf(maker).announces.load() != 0;
}

// Nothing is found of a creation that the kernel will refuse.
void Spawns::Begin(Task& maker, const TrappedCall& call) {
  const auto made = ReadCloneCall(call);
  if (!made.has_value()) return;
  const bool runs_beside = !made->HasOwnStorage() && !made->WaitsForChild();
  if (runs_beside && maker.slot >= 0) SlotOf(maker).clock.shares_storage = 1;
  if (maker.creations.size() >= kMostCreations) maker.creations.clear();
  const bool is_announced = IsAnnounced(maker);
  maker.creations.push_back({*made, is_announced});
  if (is_announced || ActsForParent(maker, *made)) return;
  maker.after_call = AfterCall::kCreations;
  maker.in_vfork = maker.expects_kernel = made->WaitsForChild();
}

bool Spawns::HasMadeChild(Task& maker, EventTime when) {
  LookForCreations(maker, when);
  // A child of the maker's parent may never be found (TakeInChild).
  return std::none_of(maker.creations.begin(), maker.creations.end(), [](const Creation& creation) {
    return creation.call.WaitsForChild() && (creation.call.flags & CLONE_PARENT) == 0;
  });
}

bool Spawns::IsUnborn(pid_t tid, EventTime when) {
  const pid_t pid = ProcessOfThread(tid);
  const Process* process = run_.table.LivingProcess(pid);
  const bool is_thread = process != nullptr;
  if (!is_thread) process = run_.table.LivingProcess(ParentOf(pid));
  if (process == nullptr) return false;
  bool is_expected = false;
  for (Task* maker : run_.table.ThreadsOf(*process)) {
    LookForCreations(*maker, when);
    is_expected |=
        std::any_of(maker->creations.begin(), maker->creations.end(),
                    [](const Creation& creation) { return creation.call.MakesThread(); });
  }
  return is_thread && is_expected && run_.table.Living(tid) == nullptr;
}

Task* Spawns::ActsFor(pid_t tid) {
  const pid_t pid = ProcessOfThread(tid);
  if (run_.table.LivingProcess(pid) != nullptr) return nullptr;
  const Process* parent = run_.table.LivingProcess(ParentOf(pid));
  if (parent == nullptr) return nullptr;
  const auto acts = [&parent](const Task* maker) {
    return ThreadState(maker->tid) == 'D' &&
           std::any_of(
               maker->creations.begin(), maker->creations.end(),
               [&](const Creation& creation) { return ActsForParent(*maker, creation.call); });
  };
  for (Task* maker : run_.table.ThreadsOf(*parent)) {
    if (acts(maker)) return maker;
  }
  return nullptr;
}

// `is_done`: a creation that is not found will never be there.
void Spawns::TakeIn(Task& maker, EventTime when, bool announced_too, bool is_done) {
  if (maker.creations.empty()) return;
  std::vector<Creation> left;
  for (const Creation& creation : std::exchange(maker.creations, {})) {
    const CloneCall& call = creation.call;
    // While the child acts for its parent, whatever the child says is said as by the parent.
    const bool acts = ActsForParent(maker, call) && (!is_done || ThreadState(maker.tid) == 'D');
    const auto take_in = [&] {
      return call.MakesThread() ? TakeInThread(maker, call, when) : TakeInChild(maker, call, when);
    };
    const bool is_left = acts || (creation.is_announced && !announced_too);
    if (is_left || (!take_in() && !is_done)) left.push_back(creation);
  }
  maker.creations.insert(maker.creations.begin(), left.begin(), left.end());
}

bool Spawns::IsNew(const Task& maker, pid_t tid) const {
  return run_.table.Living(tid) == nullptr && !parts_.unregistered.IsLowered(tid) &&
         IsThreadOf(maker.process->pid, tid);
}

// 0: the thread is not there, or not yet.
pid_t Spawns::ThreadOf(const Task& maker, const CloneCall& call) const {
  const auto told = [&](const CloneCall& by) {
    const Process& of = *maker.process;
    pid_t tid = 0;
    if (by.tid_address == 0 || !ReadMemory(of.pid, by.tid_address, &tid, sizeof tid)) return 0;
    if (of.pid_namespace != 0) tid = ThreadByOwnNumber(of.pid, tid);
    return IsNew(maker, tid) ? tid : 0;
  };
  if (const pid_t tid = told(call); tid != 0) return tid;
  for (const pid_t tid : ThreadsOf(maker.process->pid)) {
    const bool is_anothers =
        std::any_of(maker.creations.begin(), maker.creations.end(),
                    [&](const Creation& creation) { return told(creation.call) == tid; });
    if (!is_anothers && IsNew(maker, tid)) return tid;
  }
  return 0;
}

Task& Spawns::AddThread(Task& maker, pid_t tid, VirtualTime at) {
  parts_.executor.Hold(tid);
  Task& thread = parts_.thread_creation.AddThread(*maker.process, tid, at);
  parts_.scheduling.Inherit(thread, maker);
  return thread;
}

Task& Spawns::AddChild(Task& maker, pid_t pid, VirtualTime at) {
  parts_.executor.Hold(pid);
  Task& child = parts_.thread_creation.AddChild(pid, ParentOf(pid), *maker.process, at);
  parts_.scheduling.Inherit(child, maker);
  return child;
}

bool Spawns::TakeInThread(Task& maker, const CloneCall& call, EventTime when) {
  const pid_t tid = ThreadOf(maker, call);
  if (tid == 0) return false;
  Task& thread = AddThread(maker, tid, when.at);
  parts_.registration.GivePlace(thread, when, call.end_word, true);
  thread.can_be_stopped &= call.HasOwnStorage();
  thread.tls = call.tls;
  return true;
}

bool Spawns::TakeInChild(Task& maker, const CloneCall& call, EventTime when) {
  if (call.SharesMemory() && !call.WaitsForChild()) {
    parts_.unregistered_children.LookFor(*maker.process);
    return true;
  }
  const Process& of = *maker.process;
  const pid_t parent = (call.flags & CLONE_PARENT) != 0 ? of.parent : of.pid;
  if (parent == getpid()) return false;  // the child cannot be told from others
  for (const pid_t pid : ChildrenOf(parent)) {
    const char state = ThreadState(pid);
    if (state == 'X' || state == 'Z' || run_.table.LivingProcess(pid) != nullptr ||
        run_.table.IsBroker(pid) || parts_.unregistered_children.living().contains(pid)) {
      continue;
    }
    Task& child = AddChild(maker, pid, when.at);
    // A child that has executed another program attaches, unless that program has no shim.
    const bool has_executed = call.SharesMemory();
    child.process->is_bare =
        has_executed ? parts_.bare_programs.TakeUnknown(pid) : maker.process->is_bare;
    if (!has_executed || child.process->is_bare) {
      parts_.registration.GivePlace(child, when, 0, !has_executed);
    }
    return true;
  }
  return false;
}

void Spawns::Announced(Task& maker, const shm::Notification& note) {
  if (note.kind == shm::NotificationKind::kMadeThread) {
    AnnouncedThread(maker, note);
  } else {
    AnnouncedProcess(maker, static_cast<pid_t>(note.args[0]));
  }
  // Nobody tells of the other threads and processes that were made on the way.
  MakerSpeaks(maker, {maker.reached});
}

void Spawns::AnnouncedThread(Task& maker, const shm::Notification& note) {
  const auto tls = static_cast<std::uint64_t>(note.args[0]);
  Task* thread = nullptr;
  const auto is_it = [tls](const Creation& creation) {
    return creation.call.MakesThread() && creation.call.tls == tls;
  };
  const auto found = std::find_if(maker.creations.begin(), maker.creations.end(), is_it);
  if (found != maker.creations.end()) {
    const CloneCall call = found->call;
    std::erase_if(maker.creations, is_it);
    const pid_t tid = ThreadOf(maker, call);
    if (tid != 0) thread = &AddThread(maker, tid, maker.reached);
  } else {
    for (Task* other : run_.table.ThreadsOf(*maker.process)) {
      if (other->tls == tls) thread = other;
    }
  }
  if (thread == nullptr) return;
  if (note.args[1] >= 0) {
    parts_.scheduling.SetPriority(maker, *thread, note.args[1], note.args[2]);
  }
  if (note.args[3] != 0) {
    parts_.scheduling.SetAffinity(maker, *thread, static_cast<std::uint64_t>(note.args[3]));
  }
}

// Only a child of the maker's own, or with CLONE_PARENT of the maker's parent. The child has not
// been waited for, so that its number is nobody else's.
void Spawns::AnnouncedProcess(Task& maker, pid_t pid) {
  const auto is_it = [](const Creation& creation) {
    return creation.is_announced && !creation.call.MakesThread();
  };
  const auto found = std::find_if(maker.creations.begin(), maker.creations.end(), is_it);
  if (found != maker.creations.end()) maker.creations.erase(found);
  const Process& of = *maker.process;
  if (of.pid_namespace != 0) pid = ChildByOwnNumber(of.pid, pid);
  if (pid <= 0 || run_.table.LivingProcess(pid) != nullptr || run_.table.Living(pid) != nullptr)
    return;
  if (ThreadState(pid) == 'X' || ThreadState(pid) == 'Z') return;
  const pid_t actual = ParentOf(pid);
  if (actual != of.pid && (actual != of.parent || actual == getpid())) return;
  Task& child = AddChild(maker, pid, maker.reached);
  child.process->is_bare = parts_.bare_programs.TakeUnknown(pid);
  if (child.process->is_bare) parts_.registration.GivePlace(child, {maker.reached}, 0, false);
}

}  // namespace tcs
