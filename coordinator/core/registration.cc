// Threads that register themselves (shm/attach_protocol.h). Whoever can connect can say anything:
// what the kernel says of it is what counts.
#include <errno.h>
#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "coordinator/core/cpu_clock.h"
#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "shm/attach_protocol.h"

namespace tcs {

namespace {

// Who has connected says at once what it wants. Of those who do not the earliest are cut off.
constexpr std::size_t kMostSilent = 256;

shm::AttachReply NewReply() {
  shm::AttachReply reply{};
  reply.magic = shm::kMagic;
  reply.version = shm::kVersion;
  return reply;
}

// The connection never waits: a client that does not read has lost the answer.
void Send(int connection, shm::AttachReply reply, std::span<const int> fds) {
  iovec iov{&reply, sizeof reply};
  alignas(cmsghdr) char control[CMSG_SPACE(shm::kMostAttachFds * sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  if (!fds.empty()) {
    message.msg_control = control;
    message.msg_controllen = CMSG_SPACE(fds.size_bytes());
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(fds.size_bytes());
    memcpy(CMSG_DATA(header), fds.data(), fds.size_bytes());
  }
  sendmsg(connection, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
}

pid_t PeerOf(int connection) {
  ucred peer{};
  socklen_t size = sizeof peer;
  getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &peer, &size);
  return peer.pid;
}

void Refuse(int connection, const char* why) {
  shm::AttachReply reply = NewReply();
  reply.refused = 1;
  strncpy(reply.text, why, sizeof reply.text - 1);
  Send(connection, reply, {});
}

}  // namespace

void Engine::Accept(const Listener& listener) {
  UniqueFd fd(accept4(listener.fd.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!fd) return;
  AddConnection({std::move(fd), listener.client});
}

void Engine::AddConnection(Connection connection) {
  while (connections_.size() >= kMostSilent) connections_.pop_front();
  const int fd = connection.fd.get();
  connections_.push_back(std::move(connection));
  reactor_.Add(fd, EPOLLIN, {Tag::kConnection, static_cast<std::uint32_t>(fd)});
}

// The thread that registers: known already (a client, an announced child), a further thread of a
// known process, or a process that nobody announced. If whoever made it has ended, it is at least
// known which client's descendant it is: by the socket that it has come to.
Task* Engine::TaskFor(pid_t pid, pid_t tid, Process& client, Moment moment) {
  if (Task* known = KnownTask(tid); known != nullptr) {
    if (known->process->pid == pid) return known;
    EndTask(*known, moment);  // its number is another's now
  }
  if (Process* known = LivingProcess(pid); known != nullptr) {
    return AddThread(*known, tid, moment.ns);
  }
  const pid_t parent_pid = ParentOf(pid);
  const Process* parent = LivingProcess(parent_pid);
  return NewChild(pid, parent_pid, parent != nullptr ? *parent : client, moment.ns);
}

// A thread that executes another program becomes its process's first one; all others have ended,
// and nobody else says so. False where they have not: it has executed nothing.
bool Engine::EndThreadsLostInExec(pid_t pid, Moment moment) {
  Task* first = KnownTask(pid);
  Process* of = LivingProcess(pid);
  if (of == nullptr || of->threads == 1) return true;
  const std::vector<Task*> threads = of->robot->tasks;
  const bool lives_on = std::any_of(threads.begin(), threads.end(), [&](const Task* task) {
    return task->process == of && task != first && IsThreadOf(pid, task->tid) &&
           !IsDying(task->tid);
  });
  if (lives_on) return false;
  const bool by_another = turn_.IsIn(*of) && turn_.task() != first;
  if (by_another) {
    Settle(*turn_.task());
    moment.ns = turn_.task()->reached_ns;
  }
  for (Task* task : threads) {
    if (task->process != of || task == first) continue;
    EndTask(*task, moment);
    locks_.WakeThoseWaitingFor(*task, moment);
  }
  of->has_unmanaged_threads = false;
  if (first == nullptr || !by_another) return true;
  of->ended.NoteChangedClocks();
  // The processor clock under its number is another thread's from now on.
  first->cpu_clock_fd.Reset();
  first->metered.host_origin_ns = HostClockOf(*first) - first->metered.HostNs(first->charged_ns);
  return true;
}

void Engine::GiveDdsArea(int connection, pid_t pid) {
  const Process* process = LivingProcess(pid);
  const int fd = process == nullptr ? -1 : dds_.AreaOf(*process);
  if (fd < 0) return Refuse(connection, "it has not joined");
  Send(connection, NewReply(), std::span(&fd, 1));
}

// While the kernel holds the thread whose turn it is, others of the run get the processor, and so
// come as far as here. When they do depends on the host, so it must not show. True if the one that
// wants to register does it later: at its own first dispatch; or, if its maker runs and has not
// said yet that it has made it, once it has.
bool Engine::RegistersLater(const Connection& connection, pid_t* tid) const {
  shm::AttachHello hello{};
  const ssize_t n = recv(connection.fd.get(), &hello, sizeof hello, MSG_DONTWAIT | MSG_PEEK);
  if (n != sizeof hello || hello.wants == shm::AttachWants::kDdsArea) return false;
  if (hello.pid != PeerOf(connection.fd.get()) || early_connections_.contains(hello.tid) ||
      early_connections_.size() >= kMostSilent) {
    return false;
  }
  *tid = hello.tid;
  if (const Task* task = KnownTask(hello.tid); task != nullptr) {
    const bool waits_for_dispatch =
        !turn_.IsOf(*task) && task->slot < 0 && Waker::IsRunnable(*task);
    return waits_for_dispatch && task->process->pid == hello.pid;
  }
  if (!turn_.lasts()) return false;
  const pid_t running = turn_.task()->process->pid;
  const bool is_of_running =
      turn_.HasClock() && (hello.pid == running || ParentOf(hello.pid) == running);
  return gates_only_ || is_of_running;
}

// Their makers' turn is over, and nothing was said of them.
void Engine::RegisterUnannounced(Moment moment) {
  std::vector<pid_t> unknown;
  for (const auto& [tid, connection] : early_connections_) {
    if (KnownTask(tid) == nullptr) unknown.push_back(tid);
  }
  for (const pid_t tid : unknown) {
    const auto early = early_connections_.extract(tid);
    if (!early.empty()) Attach(early.mapped().fd.get(), *early.mapped().client, moment);
  }
}

// It is dispatched, and registers now.
void Engine::TakeUpRegistration(const Task& task) {
  auto early = early_connections_.extract(task.tid);
  if (early.empty()) return;
  AddConnection(std::move(early.mapped()));
}

// True if the running thread has to be stopped.
bool Engine::Attach(int connection, Process& client, Moment moment) {
  shm::AttachHello hello{};
  const ssize_t n = recv(connection, &hello, sizeof hello, MSG_DONTWAIT);
  if (n <= 0) return false;  // it has gone
  if (n != sizeof hello || hello.magic != shm::kMagic || hello.version != shm::kVersion ||
      hello.pid != PeerOf(connection)) {
    Refuse(connection, "it comes from another version of tcs");
    return false;
  }
  if (hello.wants == shm::AttachWants::kDdsArea) {
    GiveDdsArea(connection, hello.pid);
    return false;
  }
  const bool is_known = LivingProcess(hello.pid) != nullptr;
  if (!IsThreadOf(hello.pid, hello.tid) || (!is_known && !DescendsFrom(hello.pid, getpid()))) {
    Refuse(connection, "it was not started there");
    return false;
  }
  const Task* stranger = KnownTask(hello.tid);
  const bool is_anothers =
      stranger != nullptr && turn_.IsOf(*stranger) && stranger->process->pid != hello.pid;
  if (is_anothers || (hello.tid == hello.pid && !EndThreadsLostInExec(hello.pid, moment))) {
    Refuse(connection, "it has a place there already");
    return false;
  }
  Task& task = *TaskFor(hello.pid, hello.tid, client, moment);
  Process& process = *task.process;
  const bool wants_all = hello.wants == shm::AttachWants::kAll;
  if (process.expelled) return false;
  if (process.link == nullptr && wants_all) {
    process.link = ProcessLink::Make();
    if (process.link != nullptr) {
      reactor_.Add(process.link->incoming_fd(), EPOLLIN, {Tag::kPipe, process.index});
    }
  }
  if (process.link == nullptr ||
      (task.slot < 0 && (task.slot = process.link->TakeSlot(task)) < 0)) {
    Refuse(connection, "there is no room for more threads");
    return true;
  }
  task.slot_memory = &process.link->SlotAt(task.slot);
  task.metered.page = &task.slot_memory->clock;
  if (!turn_.IsOf(task)) host_cpu_.active().HoldUnknown(task);
  if (hello.tid == hello.pid) {  // a new process; or it has executed another program
    TimerCalls::DeletePosix(process);
    dds_.Leave(process, moment);
  }
  PlaceAtGate(task, moment.ns);
  shm::AttachReply reply = NewReply();
  reply.slot = static_cast<std::uint32_t>(task.slot);
  const int fds[shm::kMostAttachFds] = {memfd_.get(), process.link->memory_fd(),
                                        process.link->notify_fd()};
  Send(connection, reply, wants_all ? std::span<const int>(fds) : std::span<const int>());
  return true;
}

// Ready for its first dispatch; or for the first of another program.
void Engine::PlaceAtGate(Task& task, std::int64_t at_ns) {
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
  waker_.Leave(task);
  task.early_trap.reset();
  task.trap_id = 0;
  task.notified_early = false;
  task.reached_ns = std::max({task.reached_ns, at_ns, waker_.EarliestWake()});
  SetState(task, TaskState::kReady);
  task.parked = true;
  task.reason = shm::WakeReason::kGo;
  Refresh(*task.process->robot);
}

}  // namespace tcs
