#include "coordinator/processes/registration.h"

#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "coordinator/host/host_cpu.h"
#include "coordinator/os/open_file_limit.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/processes/attach_exchange.h"
#include "coordinator/tasks/cpu_clock.h"
#include "coordinator/tasks/spin_waits.h"

namespace tcs {

bool Registration::Heard(int fd, EventTime when) {
  std::optional<Connection> connection = parts_.sockets.Take(fd);
  if (!connection.has_value()) return false;
  const std::optional<shm::AttachHello> hello = PeekHello(fd, connection->peer);
  if (hello.has_value() && RegistersLater(*hello)) {
    parts_.reactor.Remove(fd);
    early_.insert_or_assign(hello->tid, std::move(*connection));
    return false;
  }
  return Register(*connection, when);
}

bool Registration::RegistersLater(const shm::AttachHello& hello) const {
  if (hello.wants == shm::AttachWants::kDdsArea || early_.contains(hello.tid) ||
      early_.size() >= RegistrationSockets::kMostSilent) {
    return false;
  }
  if (const Task* task = run_.table.Living(hello.tid); task != nullptr) {
    const bool waits_for_dispatch =
        !run_.turn.IsOf(*task) && (task->slot < 0 || task->is_adopted) && Waker::IsRunnable(*task);
    return waits_for_dispatch && task->process->pid == hello.pid;
  }
  if (!run_.turn.lasts()) return false;
  const pid_t running = run_.turn.task()->process->pid;
  const bool is_of_running =
      run_.turn.HasClock() && (hello.pid == running || ParentOf(hello.pid) == running);
  return run_.is_unprivileged || is_of_running;
}

void Registration::RegisterUnannounced(EventTime when) {
  std::vector<pid_t> unknown;
  for (const auto& [tid, connection] : early_) {
    if (run_.table.Living(tid) == nullptr) unknown.push_back(tid);
  }
  for (const pid_t tid : unknown) {
    const auto early = early_.extract(tid);
    if (!early.empty()) Register(early.mapped(), when);
  }
}

void Registration::LetRegister(const Task& dispatched) {
  auto early = early_.extract(dispatched.tid);
  if (!early.empty()) parts_.sockets.Add(std::move(early.mapped()));
}

// True if the running thread has to be stopped.
bool Registration::Register(const Connection& connection, EventTime when) {
  const int fd = connection.fd.get();
  const TakenHello taken = TakeHello(fd, connection.peer);
  if (taken.has_gone) return false;
  if (!taken.hello.has_value()) {
    Refuse(fd, "it comes from another version of tcs");
    return false;
  }
  const shm::AttachHello& hello = *taken.hello;
  if (hello.wants == shm::AttachWants::kDdsArea) {
    GiveDdsArea(fd, hello.pid);
    return false;
  }
  if (const char* why = WhyNot(hello, when); why != nullptr) {
    Refuse(fd, why);
    return false;
  }
  return TakePlace(fd, hello, *connection.client, when);
}

// Why the process cannot be what it says that it is; null if it is.
const char* Registration::WhyNot(const shm::AttachHello& hello, EventTime when) {
  const bool is_known = run_.table.LivingProcess(hello.pid) != nullptr;
  if (!IsThreadOf(hello.pid, hello.tid) || (!is_known && !DescendsFrom(hello.pid, getpid()))) {
    return "it was not started there";
  }
  const Task* known = run_.table.Living(hello.tid);
  const bool is_anothers =
      known != nullptr && run_.turn.IsOf(*known) && known->process->pid != hello.pid;
  const bool is_first = hello.tid == hello.pid;
  if (is_anothers || (is_first && !parts_.thread_exit.EndThreadsLostInExec(hello.pid, when))) {
    return "it has a place there already";
  }
  return nullptr;
}

// True if the running thread has to be stopped.
bool Registration::TakePlace(int connection, const shm::AttachHello& hello, Process& client,
                             EventTime when) {
  Task& task = TaskFor(hello.pid, hello.tid, client, when);
  Process& process = *task.process;
  const bool wants_all = hello.wants == shm::AttachWants::kAll;
  if (process.violates_protocol) return false;
  if (process.link == nullptr && wants_all) Connect(process);
  UniqueFd brokers_end;
  if (wants_all && run_.has_brokers && !(brokers_end = GiveBroker(process))) {
    return RefuseForFiles(connection);
  }
  if (process.link == nullptr) return RefuseForFiles(connection);
  if (task.slot < 0 && (task.slot = process.link->TakeSlot(task)) < 0) {
    Refuse(connection, "there is no room for more threads");
    return true;
  }
  TakeEndWord(task, hello.end_word);
  task.slot_memory = &process.link->SlotAt(task.slot);
  task.metered.page = &task.slot_memory->clock;
  HostCpu::AllowWay(task);
  if (brokers_end) HostCpu::AllowAttach(task);
  if (!run_.turn.IsOf(task)) parts_.cpu.active().HoldUnknown(task);
  if (hello.tid == hello.pid) {
    process.is_bare = false;
    callbacks_.starts_anew(process, when);
  }
  PlaceAtGate(task, when.at, !std::exchange(task.is_adopted, false));
  task.can_be_stopped = true;
  const int fds[shm::kMostAttachFds] = {memory_fd_, process.link->memory_fd(),
                                        process.link->notify_fd(), brokers_end.get()};
  const std::size_t count = !wants_all ? 0 : brokers_end ? 4 : 3;
  Accept(connection, static_cast<std::uint32_t>(task.slot), std::span(fds, count));
  return true;
}

// A process that waits at the sockets for an answer would wait for ever, and the run's end for it.
void Registration::EndForWantOfFiles() {
  if (run_.report.error.empty()) run_.report.error = WhyNoFurtherFile();
  parts_.sockets.Close();
}

// True: the run ends.
bool Registration::RefuseForFiles(int connection) {
  EndForWantOfFiles();
  Refuse(connection, "tcsim can open no files for it");
  return true;
}

Task* Registration::Adopt(pid_t tid, EventTime when) {
  const pid_t pid = ProcessOfThread(tid);
  Process* known = run_.table.LivingProcess(pid);
  const Process* maker = known != nullptr ? known : run_.table.LivingProcess(ParentOf(pid));
  if (maker == nullptr || !(parts_.bare_programs.TakeUnknown(pid) || maker->is_bare)) {
    return nullptr;
  }
  Task* task = run_.table.Living(tid);
  if (task == nullptr && known != nullptr)
    task = &parts_.thread_creation.AddThread(*known, tid, when.at);
  if (task == nullptr) task = &parts_.thread_creation.AddChild(pid, maker->pid, *maker, when.at);
  task->process->is_bare = true;
  GivePlace(*task, when, 0, false);
  if (task->slot < 0) return task;
  parts_.cpu.active().HoldUnknown(*task);
  task->parked = true;  // in its call
  return task;
}

// No thread reads the slot, until it attaches. The first thread of a program that another one has
// executed keeps the slot that it had.
void Registration::GivePlace(Task& task, EventTime when, std::uint64_t end_word, bool is_newborn) {
  Process& process = *task.process;
  if (process.link == nullptr) Connect(process);
  if (process.link == nullptr || (task.slot = process.link->TakeSlot(task)) < 0) return;
  task.slot_memory = &process.link->SlotAt(task.slot);
  task.metered.page = &task.slot_memory->clock;
  TakeEndWord(task, end_word);
  task.is_adopted = true;
  task.can_be_stopped = !process.is_bare;
  PlaceAtGate(task, when.at, true);
  task.parked = false;
  // The computing of the thread from here on is its own, before its first dispatch, too.
  task.metered.host_origin_ns = is_newborn ? 0 : HostClockOf(task);
  HostCpu::AllowWay(task);
}

// The thread that registers: known already (a client, an announced child), a further thread of a
// known process, or a process that nobody announced. If the maker of the process has ended, it is
// at least known which client's descendant the process is: by the socket that it has come to.
Task& Registration::TaskFor(pid_t pid, pid_t tid, Process& client, EventTime when) {
  if (Task* known = run_.table.Living(tid); known != nullptr) {
    if (known->process->pid == pid) return *known;
    parts_.thread_exit.End(*known, when);  // the thread's number is another's now
  }
  if (Process* known = run_.table.LivingProcess(pid); known != nullptr) {
    return parts_.thread_creation.AddThread(*known, tid, when.at);
  }
  const pid_t parent_pid = ParentOf(pid);
  const Process* parent = run_.table.LivingProcess(parent_pid);
  return parts_.thread_creation.AddChild(pid, parent_pid, parent != nullptr ? *parent : client,
                                         when.at);
}

// The C library has taken back what an ended thread had there. A thread that waits there already
// joins.
void Registration::TakeEndWord(Task& task, std::uint64_t address) {
  for (Task& other : run_.table.tasks()) {
    if (other.process != task.process) continue;
    if (other.end_word == address) other.end_word = 0;
    auto* wait = other.Awaits<awaited::Futex>();
    if (wait == nullptr) continue;
    const bool joins = address == 0 ? wait->holds == task.own_tid : wait->address == address;
    if (joins) wait->names_tid = task.tid;
  }
  task.end_word = address;
}

void Registration::GiveDdsArea(int connection, pid_t pid) {
  const Process* process = run_.table.LivingProcess(pid);
  const int fd = process == nullptr ? -1 : callbacks_.dds_area_of(*process);
  if (fd < 0) return Refuse(connection, "it has not joined");
  Accept(connection, 0, std::span(&fd, 1));
}

// The link may still be null afterwards.
void Registration::Connect(Process& process) {
  process.link = ProcessLink::Make();
  if (process.link == nullptr) return;
  parts_.reactor.Add(process.link->incoming_fd(), EPOLLIN, {Tag::kPipe, process.index});
}

// The end of a connection for the broker that the process is about to make; none: errno is set.
UniqueFd Registration::GiveBroker(Process& process) {
  process.broker.reset();  // of the program before
  process.broker = DescriptorBroker::Make([this, name = process.name] {
    run_.Warn(name +
              ": the process that hands over its descriptors (tcs-broker) was killed or stopped, "
              "so its waits take real time until the program's next call");
  });
  return process.broker == nullptr ? UniqueFd() : process.broker->TakeClientsEnd();
}

// The thread is ready for its first dispatch, or for the first of another program. `is_first`: the
// thread had no place.
void Registration::PlaceAtGate(Task& task, VirtualTime at, bool is_first) {
  shm::ThreadSlot& slot = SlotOf(task);
  slot.pid = task.process->own_pid;
  slot.tid = task.own_tid;
  slot.cores = static_cast<std::uint32_t>(task.process->robot->cpus.size());
  slot.robot = task.process->robot->number;
  slot.seed = run_.scenario.seed * 0x9e3779b97f4a7c15 + static_cast<std::uint64_t>(task.order);
  // The draws of the process by trapped calls are a sequence of their own, which begins with the
  // program, too.
  if (is_first && task.tid == task.process->pid) task.process->draws.Seed(~slot.seed);
  slot.patch_vdso = task.process->patch_vdso ? 1 : 0;
  slot.leads_counter = task.process->leads_counter ? 1 : 0;
  slot.spin_gap_ns = SpinWaits::GapFor(run_, *task.process);
  slot.spin = {};
  slot.dds_endpoints = task.process->dds_endpoints ? 1 : 0;
  slot.signals.store(0);
  slot.open_calls.store(0);
  slot.announces.store(0);
  slot.receipts.count.store(0);
  shm::NoteStarted(slot.receipts);
  slot.gate.store(shm::kGateClosed);
  parts_.waker.Leave(task);
  task.early_trap.reset();
  task.trap_id = 0;
  task.answer_lost = false;
  task.notified_early = false;
  task.ComeTo(std::max({task.reached, at, parts_.waker.EarliestWake()}));
  parts_.waker.SetState(task, TaskState::kReady);
  task.parked = true;
  task.reason = shm::WakeReason::kGo;
  parts_.waker.Refresh(*task.process->robot);
}

}  // namespace tcs
