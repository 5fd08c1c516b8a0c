// Births and deaths: threads that register themselves, and processes that end.
#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "shm/attach_protocol.h"

namespace tcs {

namespace {

constexpr std::size_t kKeptAfterEnd = 64;

void Refuse(int connection, const char* why) {
  shm::AttachReply reply{};
  reply.magic = shm::kMagic;
  reply.version = shm::kVersion;
  reply.refused = 1;
  strncpy(reply.text, why, sizeof reply.text - 1);
  send(connection, &reply, sizeof reply, MSG_NOSIGNAL);
}

}  // namespace

// The place of one that ended long enough ago, so that nobody speaks of it any more; else a new
// one.
Task& Engine::PlaceForTask() {
  if (ended_tasks_.size() > kKeptAfterEnd) {
    Task& task = *ended_tasks_.front();
    ended_tasks_.pop_front();
    const int order = task.order;
    task = Task{};
    task.order = order;
    return task;
  }
  Task& task = tasks_.emplace_back();
  task.order = static_cast<int>(tasks_.size() - 1);
  return task;
}

// The same. A child that has not been waited for keeps its place, and so does a client.
Process& Engine::PlaceForProcess() {
  if (ended_processes_.size() > kKeptAfterEnd) {
    Process& process = *ended_processes_.front();
    ended_processes_.pop_front();
    if (ThreadState(process.pid) != 'Z') {
      const std::uint32_t index = process.index;
      process = Process{};
      process.index = index;
      return process;
    }
    ended_processes_.push_back(&process);
  }
  Process& process = processes_.emplace_back();
  process.index = static_cast<std::uint32_t>(processes_.size() - 1);
  return process;
}

Task* Engine::AddTask(Process& process, pid_t tid) {
  Task& task = PlaceForTask();
  ++living_;
  by_tid_[tid] = &task;
  task.process = &process;
  task.tid = tid;
  task.priority = process.priority;
  task.parked = false;
  task.reached_ns = task.activation.release_ns = std::max(event_ns_, EarliestWake());
  process.robot->tasks.push_back(&task);
  SetState(task, TaskState::kStarting);
  Refresh(*process.robot);
  return &task;
}

Task* Engine::NewTask(pid_t pid, pid_t parent, Robot* robot, const std::string& name, int priority,
                      const Process* maker) {
  Process& process = PlaceForProcess();
  process.pid = pid;
  process.parent = parent;
  process.robot = robot;
  process.name = name;
  process.priority = priority;
  process.pidfd = OpenPidfd(pid);
  if (maker != nullptr) {
    process.client = maker->client;
    process.call_cost_ns = maker->call_cost_ns;
    process.allocation_cost_ns = maker->allocation_cost_ns;
    process.patch_vdso = maker->patch_vdso;
    process.dds_endpoints = maker->dds_endpoints;
    process.frozen_ns = maker->frozen_ns;
    process.shown_ns = maker->shown_ns;
  }
  if (process.pidfd >= 0) {
    Watch(process.pidfd, EPOLLIN, Tag::kProcess, process.index);
  }
  Task* task = AddTask(process, pid);
  // Children have no name of their own; their place in the order is the same in every run.
  const bool is_child = maker != nullptr || parent != getpid();
  task->is_further = is_child;
  task->row = AddRow(robot->name, is_child ? fmt::format("{} #{}", name, task->order) : name);
  return task;
}

Task* Engine::AddThread(Process& process, pid_t tid) {
  ++process.threads;
  Task* task = AddTask(process, tid);
  task->is_further = true;
  task->row = AddRow(process.robot->name, fmt::format("{} #{}", process.name, task->order));
  return task;
}

Process* Engine::LivingProcess(pid_t pid) {
  const auto found = std::find_if(processes_.begin(), processes_.end(),
                                  [pid](const Process& p) { return p.pid == pid && !p.dead; });
  return found == processes_.end() ? nullptr : &*found;
}

Task* Engine::KnownTask(pid_t tid) {
  const auto known = by_tid_.find(tid);
  return known == by_tid_.end() ? nullptr : known->second;
}

Task* Engine::NewChild(pid_t pid, pid_t parent, const Process& maker) {
  return NewTask(pid, parent, maker.robot, maker.name, maker.priority, &maker);
}

// The thread that registers: known already (a client, an announced child), a further thread of a
// known process, or a process that nobody announced. If whoever made it has ended, it is at least
// known which client's descendant it is: by the socket that it has come to.
Task* Engine::TaskFor(pid_t pid, pid_t parent_pid, pid_t tid, Process& client) {
  if (Task* known = KnownTask(tid); known != nullptr) return known;
  if (Process* known = LivingProcess(pid); known != nullptr) return AddThread(*known, tid);
  const Process* parent = LivingProcess(parent_pid);
  return NewChild(pid, parent_pid, parent != nullptr ? *parent : client);
}

// A thread that executes another program becomes its process's first one; all others have ended,
// and nobody else says so.
void Engine::EndThreadsLostInExec(pid_t pid) {
  Task* first = KnownTask(pid);
  Process* of = LivingProcess(pid);
  if (of == nullptr || of->threads == 1) return;
  const bool by_another = running_ != nullptr && running_ != first && running_->process == of;
  if (by_another) {
    Settle(*running_);
    event_ns_ = running_->reached_ns;
  }
  const std::vector<Task*> threads = of->robot->tasks;
  for (Task* task : threads) {
    if (task->process != of || task == first) continue;
    EndTask(*task);
    WakeThoseWaitingFor(*task);
  }
  of->has_strangers = false;
  if (first == nullptr || !by_another) return;
  of->ended.NoteChangedClocks();
  // The processor clock under its number is another thread's from now on.
  if (first->cpu_clock_fd >= 0) close(std::exchange(first->cpu_clock_fd, -1));
  first->host_origin_ns =
      HostClockOf(*first) -
      static_cast<std::int64_t>(static_cast<double>(first->charged_ns) * of->robot->speed);
}

void Engine::Attach(int connection, Process& client) {
  shm::AttachHello hello{};
  const ssize_t n = recv(connection, &hello, sizeof hello, MSG_DONTWAIT);
  ucred peer{};
  socklen_t size = sizeof peer;
  getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &peer, &size);
  if (n != sizeof hello || hello.magic != shm::kMagic || hello.version != shm::kVersion ||
      hello.pid != peer.pid) {
    Refuse(connection, "it comes from another version of tcs");
    return;
  }
  if (hello.tid == hello.pid) EndThreadsLostInExec(hello.pid);
  Task& task = *TaskFor(hello.pid, hello.parent_pid, hello.tid, client);
  if (task.slot < 0 && free_slots_.empty()) {
    Refuse(connection, "there is no room for more threads");
    return;
  }
  if (&task != running_) {
    SetLevel(task.tid, Level::kWaiting);
    task.level = Level::kWaiting;
  }
  if (task.slot < 0) {
    task.slot = free_slots_.front();
    free_slots_.pop_front();
    by_slot_[static_cast<std::size_t>(task.slot)] = &task;
    new (&Slot(task)) shm::ThreadSlot{};
  }
  if (hello.tid == hello.pid) {  // a new process; or it has executed another program
    DeletePosixTimers(*task.process);
    LeaveDds(*task.process);
  }
  shm::ThreadSlot& slot = Slot(task);
  slot.pid = task.process->pid;
  slot.tid = task.tid;
  slot.cores = static_cast<std::uint32_t>(task.process->robot->cpus.size());
  slot.seed = scenario_.seed * 0x9e3779b97f4a7c15 + static_cast<std::uint64_t>(task.order);
  slot.patch_vdso = task.process->patch_vdso ? 1 : 0;
  slot.dds_endpoints = task.process->dds_endpoints ? 1 : 0;
  slot.signals.store(0);
  slot.receipts.count.store(0);
  shm::NoteStarted(slot.receipts);
  slot.gate.store(shm::kGateClosed);
  LeaveWait(task);
  task.early_trap.reset();
  task.trap_id = 0;
  task.notified_early = false;
  task.reached_ns = std::max({task.reached_ns, event_ns_, EarliestWake()});
  SetState(task, TaskState::kReady);
  task.parked = true;
  task.reason = shm::WakeReason::kGo;
  Refresh(*task.process->robot);
  SendReply(connection, task);
}

void Engine::SendReply(int connection, const Task& task) {
  shm::AttachReply reply{};
  reply.magic = shm::kMagic;
  reply.version = shm::kVersion;
  reply.slot = static_cast<std::uint32_t>(task.slot);
  iovec iov{&reply, sizeof reply};
  alignas(cmsghdr) char control[CMSG_SPACE(2 * sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  cmsghdr* header = CMSG_FIRSTHDR(&message);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(2 * sizeof(int));
  const int fds[2] = {memfd_, pipe_[1]};
  memcpy(CMSG_DATA(header), fds, sizeof fds);
  sendmsg(connection, &message, MSG_NOSIGNAL);
}

// Whatever the thread waits for, it waits no longer.
void Engine::LeaveWait(Task& task) {
  EndWatches(task);
  EndKeyWait(task);
  waiting_for_child_ -= task.waits_for_child;
  waiting_for_stops_ -= task.awaits_stops;
  task.awaits_stops = false;
  waiting_for_signals_ -= task.awaited_signals != 0;
  task.awaited_signals = 0;
  task.waits_for_messages = false;
  waiting_for_room_ -= task.waits_for_room != 0;
  task.waits_for_room = 0;
  if (std::exchange(task.waits_for_deliverer, false)) {
    --task.process->waiting_for_deliverer;
    if (task.process->deliverer != nullptr) FindPriority(*task.process->deliverer);
  }
  task.waits_for_child = task.waits_for_fds = task.has_wait_mask = false;
  task.trap_wait = TrapWait::kNone;
  futexes_.Leave(task.order);
  task.deadline_ns = shm::kNeverNs;
  LeaveLock(task);
}

// What the thread has had and done goes to its process. The slot goes to the end of the queue: a
// last word of its thread may still be in the pipe.
void Engine::EndTask(Task& task) {
  Process& process = *task.process;
  KeepUsageOf(task);
  if (task.cpu_clock_fd >= 0) close(task.cpu_clock_fd);
  if (task.slot >= 0) {
    const shm::ClockPage& clock = Slot(task).clock;
    report_.staleness_ns = std::max(report_.staleness_ns, clock.staleness_ns.load());
    by_slot_[static_cast<std::size_t>(task.slot)] = nullptr;
  }
  if (process.deliverer == &task) process.deliverer = nullptr;
  PassOn(task);
  LeaveWait(task);
  SetState(task, TaskState::kDead);
  --living_;
  task.parked = true;
  std::erase(task.process->robot->tasks, &task);
  if (task.slot >= 0) free_slots_.push_back(task.slot);
  if (last_ == &task) last_ = nullptr;
  by_tid_.erase(task.tid);
  ended_tasks_.push_back(&task);
  Refresh(*task.process->robot);
}

void Engine::ProcessEnded(std::size_t index) {
  Process& process = processes_[index];
  if (process.dead) return;
  if (running_ != nullptr && running_->process == &process) {
    Settle(*running_);
    event_ns_ = running_->reached_ns;
  }
  process.dead = true;
  process.ended_at_ns = event_ns_;
  const std::vector<Task*> threads = process.robot->tasks;
  for (Task* task : threads) {
    if (task->process != &process) continue;
    EndTask(*task);
    WakeThoseWaitingFor(*task);
  }
  KeepUsageOf(process);
  for (auto& [id, timer] : process.timers) {
    if (timer.fd >= 0) close(std::exchange(timer.fd, -1));
  }
  epoll_ctl(epoll_, EPOLL_CTL_DEL, process.pidfd, nullptr);
  close(process.pidfd);
  process.pidfd = -1;
  Process* parent = LivingProcess(process.parent);
  if (parent != nullptr) {
    parent->children_cpu_ns += process.ended.usage().charged_ns + process.children_cpu_ns;
    ++parent->children_changed;
  }
  for (Task& task : tasks_) {
    if (task.waits_for_child && task.process->pid == process.parent &&
        (task.awaited_child <= 0 || task.awaited_child == process.pid)) {
      MakeReady(task, shm::WakeReason::kGo);
    }
  }
  if (parent != nullptr) WakeForSignals(*parent);
  StartThoseAfter(process);
  WakeEveryKey();
  LeaveDds(process);
  if (!process.is_client) ended_processes_.push_back(&process);
  const std::optional<int> status = WaitStatusOf(process.pid);
  if (!status.has_value()) return;  // its parent's to reap
  process.wait_status = *status;
  // Of several threads the last may still be at what LetDie says: those are reaped at the run's
  // end, when nobody here is at a real-time priority any more.
  if (process.threads == 1) waitpid(process.pid, nullptr, WNOHANG);
  if (index == 0) {
    report_.exit_status = WIFEXITED(*status) ? WEXITSTATUS(*status) : 128 + WTERMSIG(*status);
  }
}

}  // namespace tcs
