#include "coordinator/calls/dds_gateway.h"

#include <dds/version.h>
#include <errno.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "coordinator/os/signal_bits.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/scenario/own_topics.h"
#include "coordinator/tasks/signal_sets.h"

namespace tcs {

std::string DdsGateway::Open() {
  if (std::string error = records_.Open(); !error.empty()) return error;
  if (record::MessageSink* sink = records_.sink()) world_.RecordInto(*sink);
  world_.Begin(run_.header->realtime_offset_ns);
  records_.ReadNewTopics(0);
  return {};
}

const Process* DdsGateway::ProcessOf(dds::Hub::Number number) const {
  const auto process = std::ranges::find_if(
      joined_, [number](const Process* one) { return one->dds_number == number; });
  return process == joined_.end() ? nullptr : *process;
}

dds::Speaker DdsGateway::WhoIs(dds::Hub::Number number) const {
  if (number == shm::kDdsCoordinator) return {"tcsim", ""};
  const Process* process = ProcessOf(number);
  return process == nullptr ? dds::Speaker{} : dds::Speaker{process->name, process->robot->name};
}

void DdsGateway::TakeOwnMessages() {
  const VirtualTime until = std::min(run_.root.Least(), run_.end);
  if (RobotTime(hub_.OwnDueNs()) > until) return;
  if (world_.present() && !run_.IsInGrace()) world_.ReceiveUntold(until);
  // Drops messages that were for none of the channels, or are from after the channels' end.
  while (ends_.Take(until.ns()).has_value()) {
  }
  ShowDeliverersTheirDeadlines();
}

void DdsGateway::Handle(Task& task, const shm::Notification& note, VirtualTime deadline) {
  Process& process = *task.process;
  switch (note.kind) {
    case shm::NotificationKind::kDdsJoin:
      Join(task);
      break;
    case shm::NotificationKind::kDdsSend:
      Send(process, static_cast<std::size_t>(note.args[0]), task);
      break;
    case shm::NotificationKind::kDdsWait:
      AwaitMessages(task);
      break;
    case shm::NotificationKind::kDdsRoom: {
      const auto receiver = static_cast<dds::Hub::Number>(note.args[0]);
      if (hub_.IsFull(receiver)) waker_.Wait(task, {awaited::Room{receiver}, deadline});
      break;
    }
    case shm::NotificationKind::kDdsSockets:
      WarnOfSockets(process, static_cast<shm::WhySockets>(note.args[0]));
      break;
    default:
      AwaitDeliverer(task, deadline);
  }
}

// The deliverer inherits the priority of the threads that wait for it.
void DdsGateway::AwaitDeliverer(Task& task, VirtualTime deadline) {
  Process& process = *task.process;
  if (!IsDelivering(process, task.reached)) return;
  waker_.Wait(task, {awaited::Deliverer{}, deadline});
  PriorityInheritance::BlockOn(task, process.deliverer);
  inheritance_.Find(*process.deliverer);
}

// A wrong message is warned of once for each client: a process may send as often as it likes.
void DdsGateway::Send(Process& process, std::size_t bytes, Task& by) {
  const VirtualTime at = by.reached;
  SampleFeed* const feed = records_.samples();
  if (feed != nullptr) feed->BeginSending(&by);
  const std::string wrong = hub_.Send(process.dds_number, bytes, at.ns(), by.charged.ns());
  if (feed != nullptr) feed->BeginSending(nullptr);
  if (!wrong.empty() && !std::exchange(process.client->dds_warned, true)) {
    run_.Warn(fmt::format("{} {}", process.name, wrong));
  }
  run_.ChargePrice(by, costs_.TakeForSent());
  records_.ReadNewTopics(at.ns());
  ShowDeliverersTheirDeadlines();
}

// The process says so itself on its stderr, which is a file here that nobody may look into.
void DdsGateway::WarnOfSockets(const Process& process, shm::WhySockets why) {
  if (run_.options.output_directory.empty()) return;
  const char* reason = "libtcs_dds.so cannot be loaded into it";
  const char* mend = "see its .err.log";
  switch (why) {
    case shm::WhySockets::kOtherLibrary:
      reason = "its Cyclone DDS is not Debian's libddsc.so." DDS_VERSION;
      mend = "link it with that one";
      break;
    case shm::WhySockets::kLooksUpItself:
      reason = "it looks up Cyclone DDS's functions by itself, as Python's ctypes does";
      mend = "use a program that is linked with libddsc";
      break;
    case shm::WhySockets::kNoRoom:
      reason = "the run's shared memory has no room for it";
      mend =
          "start fewer programs: a run has room for 1024 that speak DDS, including the ones that "
          "have ended";
      break;
    case shm::WhySockets::kNoLibraryOfOurs:
      break;
  }
  const bool are_served = std::ranges::any_of(run_.robots, &Robot::is_ours);
  const std::string topics = are_served ? "" : NamesOfOwnTopics(run_.scenario);
  const std::string missed = topics.empty()
                                 ? "programs whose DDS is in shared memory"
                                 : "the scenario's topics in shared memory (" + topics + ")";
  const char* other_way = topics.empty() ? ""
                          : run_.scenario.network
                              ? ", or give it channels of the type udp_json"
                              : ", or give the client `dds: sockets`, and it meets them there";
  run_.Warn(fmt::format("the DDS of {} uses sockets because {}, so it never meets {}; {}{}",
                        process.name, reason, missed, mend, other_way));
}

void DdsGateway::Join(Task& task) {
  Process& process = *task.process;
  Leave(process, {task.reached});
  process.dds_number = hub_.Join(task.reached.ns());
  task.reply[0] = process.dds_number != 0 ? process.dds_number : -errno;
  task.reply[1] = run_.scenario.drift_bound.ns();
  if (process.dds_number != 0) joined_.push_back(&process);
}

void DdsGateway::Leave(Process& process, EventTime when) {
  if (Task* deliverer = std::exchange(process.deliverer, nullptr); deliverer != nullptr) {
    deliverer->is_deliverer = false;
    ReleaseThoseAwaitingDeliverer(process, when);
  }
  if (process.dds_number == 0) return;
  std::erase(joined_, &process);
  const std::uint32_t number = std::exchange(process.dds_number, 0);
  hub_.Leave(number, when.at.ns());
  ReleaseThoseAwaitingRoom(number, when);
  ShowDeliverersTheirDeadlines();
}

// The deliverer has nothing more to hand over, and waits until something is due.
void DdsGateway::AwaitMessages(Task& task) {
  Process& process = *task.process;
  if (process.deliverer != &task) {
    process.deliverer = &task;
    task.is_deliverer = true;
  }
  hub_.CameBack(process.dds_number);
  ReleaseThoseAwaitingRoom(process.dds_number, {task.reached});
  waker_.Wait(task, {awaited::Messages{}, RobotTime(hub_.DueNs(process.dds_number))});
  ReleaseThoseAwaitingDeliverer(process, {task.reached});
}

// Whether the first message that is due takes no time to receive: it is there when it is due.
bool DdsGateway::IsFirstDueFree(const Process& process, VirtualTime now) const {
  bool is_free = true;
  hub_.ForEachDue(process.dds_number, now.ns(), [&](const shm::DdsMessage& header) {
    is_free = costs_.ForReceiving(process, header) == VirtualDuration();
    return false;
  });
  return is_free;
}

// Whether the messages that are due at `now` are being handed over, or are about to be. A message
// for which the deliverer has still to work is not there yet, as natively.
bool DdsGateway::IsDelivering(const Process& process, VirtualTime now) const {
  const Task* deliverer = process.deliverer;
  if (deliverer == nullptr) return false;
  if (deliverer->Awaits<awaited::Messages>() != nullptr) {
    return RobotTime(hub_.DueNs(process.dds_number)) <= now && IsFirstDueFree(process, now);
  }
  if (!Waker::IsRunnable(*deliverer)) return false;
  if (!deliverer->messages_until.has_value()) return true;
  if (deliverer->messages_charged.has_value()) return deliverer->debt <= VirtualDuration();
  return IsFirstDueFree(process, std::max(now, *deliverer->messages_until));
}

void DdsGateway::ReleaseThoseAwaitingDeliverer(const Process& process, EventTime when) {
  if (waker_.counts().for_deliverer() == 0) return;
  for (Task* task : process.robot->tasks) {
    if (task->process != &process || task->Awaits<awaited::Deliverer>() == nullptr) continue;
    if (!IsDelivering(process, task->reached)) {
      waker_.Wake(*task, shm::WakeReason::kGo, when);
    }
  }
}

// Releases the threads that sent to a process more than it can take at once.
void DdsGateway::ReleaseThoseAwaitingRoom(std::uint32_t number, EventTime when) {
  if (waker_.counts().for_room() == 0 || hub_.IsFull(number)) return;
  for (Task& task : run_.table.tasks()) {
    const auto* wait = task.Awaits<awaited::Room>();
    if (wait == nullptr || wait->process != number) continue;
    waker_.Wake(task, shm::WakeReason::kGo, when);
  }
}

void DdsGateway::ShowDeliverersTheirDeadlines() {
  for (const Process* process : joined_) {
    Task* deliverer = process->deliverer;
    if (deliverer == nullptr || deliverer->Awaits<awaited::Messages>() == nullptr) continue;
    const VirtualTime due = RobotTime(hub_.DueNs(process->dds_number));
    if (std::exchange(deliverer->wait->deadline, due) == due) continue;
    SchedulerOf(*deliverer).WaitChanged(deliverer->order);
    const bool inside = run_.turn.IsOn(*process->robot);
    if (!due.IsNever() && !inside) {
      waker_.NoteLateness(*deliverer, due,
                          SchedulerOf(*deliverer).PreemptsOnWakeup(deliverer->order));
    }
    waker_.Refresh(*process->robot);
  }
}

// A process is stopped as a whole as soon as a signal that stops it is there, though its threads
// notice one after another.
void DdsGateway::NoteWhetherStopped(const Process& process, VirtualTime at) {
  if (process.dds_number == 0) return;
  bool stopped = false;
  for (Task& task : run_.table.tasks()) {
    if (task.process != &process || task.state == TaskState::kDead) continue;
    const SignalSets sets = SignalsOf(run_, task);
    const std::uint64_t ignored = sets.blocked | sets.caught;
    stopped |= ThreadState(task.tid) == 'T' ||
               ((sets.own_pending | sets.shared_pending) & kStopSignals & ~ignored) != 0;
  }
  if (stopped) {
    hub_.Stop(process.dds_number, at.ns());
  } else {
    hub_.Continue(process.dds_number, at.ns());
  }
  ShowDeliverersTheirDeadlines();
}

// One after the other, as from a socket: a sample is there once it has been paid, though more are
// due already. What comes meanwhile waits for the deliverer's next turn.
void DdsGateway::ChargeForDue(Task& task) {
  constexpr VirtualDuration kMostAtOnce = VirtualDuration::Microseconds(50);
  if (!task.messages_until.has_value() || task.messages_charged.has_value()) return;
  task.messages_until = std::max(*task.messages_until, task.cpu->progress);
  std::size_t count = 0;
  VirtualDuration price;
  hub_.ForEachDue(task.process->dds_number, task.messages_until->ns(),
                  [&](const shm::DdsMessage& header) {
                    ++count;
                    price += costs_.ForReceiving(*task.process, header);
                    return price < kMostAtOnce;
                  });
  task.messages_charged = count;
  run_.ChargePrice(task, price);
}

void DdsGateway::HandOver(Task& task) {
  const std::optional<VirtualTime> until = std::exchange(task.messages_until, std::nullopt);
  const std::size_t count = std::exchange(task.messages_charged, std::nullopt).value_or(0);
  if (!until.has_value()) return;
  const std::size_t bytes = hub_.Deliver(task.process->dds_number, until->ns(), count);
  task.reply[0] = static_cast<std::int64_t>(bytes);
}

}  // namespace tcs
