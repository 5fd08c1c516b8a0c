// Programs that speak DDS: who has joined, what they send each other, and the thread of each that
// takes what is for it (shm/dds_exchange.h).
#include <dds/version.h>
#include <errno.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/scenario/own_topics.h"

namespace tcs {

std::string Engine::OpenDds() {
  const std::string& directory = options_.output_directory;
  if (!directory.empty()) {
    std::error_code ignored;  // of an earlier run into the same folder
    std::filesystem::remove(directory + "/topics.json", ignored);
    std::filesystem::remove_all(directory + "/bag", ignored);
    hub_.Observe(&topic_log_);
  }
  if (options_.record) {
    recording_.emplace(topic_log_, ends_, header_->realtime_offset_ns);
    topic_log_.Tell(&*recording_);
    if (std::string error = recording_->Open(directory + "/bag"); !error.empty()) {
      topic_log_.Tell(nullptr);
      recording_.reset();
      return error;
    }
  }
  world_.Begin(header_->realtime_offset_ns);
  if (recording_.has_value()) recording_->ReadNewTopics(0);
  return {};
}

std::string Engine::CloseDds() {
  const std::vector<dds::TopicReport>& topics = topic_log_.reports();
  std::string error;
  if (!topics.empty()) {
    error = dds::WriteTopics(topics, options_.output_directory + "/topics.json");
  }
  if (recording_.has_value()) {
    if (std::string missing = recording_->Close(); error.empty()) error = std::move(missing);
  }
  return error;
}

void Engine::WarnOfDrops() {
  const dds::Hub::Drops& drops = hub_.drops();
  const auto say = [this](std::uint64_t count, const char* what) {
    if (count > 0) Warn(fmt::format("{} DDS samples {}", count, what));
  };
  say(drops.lost,
      "were dropped, because a program has stopped taking what is sent to it and 256 MiB were "
      "waiting: look for a listener that never returns");
  say(drops.unreliable,
      "that no reader was promised (best effort) were dropped, because 1 MiB was waiting for a "
      "program that takes more slowly: tcsim topics says of which topics");
  say(drops.replaced,
      "were replaced by later ones of writers that keep the last, because 1 MiB was waiting for a "
      "program that takes more slowly: tcsim topics says of which topics");
  if (!topic_log_.is_whole()) {
    Warn(fmt::format(
        "the programs have made more than {} different writers and readers of DDS "
        "topics: topics.json{} of the first ones only; do names or QoS have a counter "
        "in them?",
        dds::TopicLog::kMostEnds, recording_.has_value() ? " and bag/ tell" : " tells"));
  }
}

dds::Speaker Engine::WhoIs(dds::Hub::Number number) const {
  if (number == shm::kDdsCoordinator) return {"tcsim", ""};
  for (const Process* process : dds_processes_) {
    if (process->dds_number == number) return {process->name, process->robot->name};
  }
  return {};
}

// What is from before anything that can still be sent.
void Engine::TakeOwnMessages() {
  const std::int64_t until = std::min(root_.Least(), end_ns_);
  if (hub_.OwnDueNs() > until) return;
  if (WorldGoesOn()) world_.ReceiveUntold(until);
  // What was for none of the channels, or is from after their end.
  while (ends_.Take(until).has_value()) {
  }
  ShowDeliverersTheirDeadlines();
}

void Engine::HandleDds(Task& task, const shm::Notification& note, std::int64_t deadline_ns) {
  Process& process = *task.process;
  switch (note.kind) {
    case shm::NotificationKind::kDdsJoin:
      JoinDds(task);
      break;
    case shm::NotificationKind::kDdsSend:
      SendDds(process, static_cast<std::size_t>(note.args[0]), task.reached_ns);
      break;
    case shm::NotificationKind::kDdsWait:
      AwaitMessages(task);
      break;
    case shm::NotificationKind::kDdsRoom: {
      const auto receiver = static_cast<dds::Hub::Number>(note.args[0]);
      if (hub_.IsFull(receiver)) EnterWait(task, {awaited::Room{receiver}, deadline_ns});
      break;
    }
    case shm::NotificationKind::kDdsSockets:
      WarnOfSockets(process, static_cast<shm::WhySockets>(note.args[0]));
      break;
    default:
      if (!IsDelivering(process, task.reached_ns)) break;
      EnterWait(task, {awaited::Deliverer{}, deadline_ns});
      SchedulerOf(task).SetBlockedOn(task.order, process.deliverer->order);
      FindPriority(*process.deliverer);
  }
}

// What is wrong is said once of each process: it may send as often as it likes.
void Engine::SendDds(Process& process, std::size_t bytes, std::int64_t at_ns) {
  const std::string wrong = hub_.Send(process.dds_number, bytes, at_ns);
  if (!wrong.empty() && !std::exchange(process.client->dds_warned, true)) {
    Warn(fmt::format("{} {}", process.name, wrong));
  }
  if (recording_.has_value()) recording_->ReadNewTopics(at_ns);
  ShowDeliverersTheirDeadlines();
}

// It says so itself on its stderr, which is a file here that nobody may look into.
void Engine::WarnOfSockets(const Process& process, shm::WhySockets why) {
  if (options_.output_directory.empty()) return;
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
      reason = "there is no room for it in shared memory";
      mend = "a run has room for 1024 of them, those that have ended included: start fewer";
      break;
    case shm::WhySockets::kNoLibraryOfOurs:
      break;
  }
  const std::string topics = NamesOfOwnTopics(scenario_);
  const std::string missed = topics.empty()
                                 ? "programs whose DDS is in shared memory"
                                 : "the scenario's topics in shared memory (" + topics + ")";
  const char* other_way = topics.empty() ? "" : ", or give it channels of the type udp_json";
  Warn(fmt::format("the DDS of {} uses sockets, as {}, so that it never meets {}; {}{}",
                   process.name, reason, missed, mend, other_way));
}

void Engine::JoinDds(Task& task) {
  Process& process = *task.process;
  LeaveDds(process, {task.reached_ns});
  process.dds_number = hub_.Join(task.reached_ns);
  task.reply[0] = process.dds_number != 0 ? process.dds_number : -errno;
  task.reply[1] = scenario_.drift_bound.ns();
  if (process.dds_number != 0) dds_processes_.push_back(&process);
}

// It has died, or executes another program.
void Engine::LeaveDds(Process& process, Moment moment) {
  if (Task* deliverer = std::exchange(process.deliverer, nullptr); deliverer != nullptr) {
    deliverer->is_deliverer = false;
    ReleaseThoseAwaitingDeliverer(process, moment);
  }
  if (process.dds_number == 0) return;
  std::erase(dds_processes_, &process);
  const std::uint32_t number = std::exchange(process.dds_number, 0);
  hub_.Leave(number, moment.ns);
  ReleaseThoseAwaitingRoom(number, moment);
  ShowDeliverersTheirDeadlines();
}

// The deliverer has nothing more to hand over, and waits until something is due.
void Engine::AwaitMessages(Task& task) {
  Process& process = *task.process;
  if (process.deliverer != &task) {
    process.deliverer = &task;
    task.is_deliverer = true;
  }
  hub_.CameBack(process.dds_number);
  ReleaseThoseAwaitingRoom(process.dds_number, {task.reached_ns});
  EnterWait(task, {awaited::Messages{}, hub_.DueNs(process.dds_number)});
  ReleaseThoseAwaitingDeliverer(process, {task.reached_ns});
}

// Whether what is due at `now_ns` is being handed over, or is about to be.
bool Engine::IsDelivering(const Process& process, std::int64_t now_ns) const {
  const Task* deliverer = process.deliverer;
  if (deliverer == nullptr) return false;
  if (deliverer->Awaits<awaited::Messages>() != nullptr) {
    return hub_.DueNs(process.dds_number) <= now_ns;
  }
  return IsRunnable(*deliverer);
}

void Engine::ReleaseThoseAwaitingDeliverer(const Process& process, Moment moment) {
  if (wait_counts_.for_deliverer() == 0) return;
  for (Task* task : process.robot->tasks) {
    if (task->process != &process || task->Awaits<awaited::Deliverer>() == nullptr) continue;
    if (!IsDelivering(process, task->reached_ns)) {
      MakeReady(*task, shm::WakeReason::kGo, moment);
    }
  }
}

// Those that sent to a process more than it can take at once.
void Engine::ReleaseThoseAwaitingRoom(std::uint32_t number, Moment moment) {
  if (wait_counts_.for_room() == 0 || hub_.IsFull(number)) return;
  for (Task& task : table_.tasks()) {
    const auto* wait = task.Awaits<awaited::Room>();
    if (wait == nullptr || wait->process != number) continue;
    MakeReady(task, shm::WakeReason::kGo, moment);
  }
}

void Engine::ShowDeliverersTheirDeadlines() {
  for (const Process* process : dds_processes_) {
    Task* deliverer = process->deliverer;
    if (deliverer == nullptr || deliverer->Awaits<awaited::Messages>() == nullptr) continue;
    const std::int64_t due = hub_.DueNs(process->dds_number);
    if (std::exchange(deliverer->wait->deadline_ns, due) == due) continue;
    const bool inside = turn_.IsOn(*process->robot);
    if (due != shm::kNeverNs && !inside) {
      NoteLateness(*deliverer, due, SchedulerOf(*deliverer).PreemptsOnWakeup(deliverer->order));
    }
    Refresh(*process->robot);
  }
}

// At the dispatch of a deliverer whose wait is over.
void Engine::HandMessagesOver(Task& task) {
  const std::int64_t until = std::exchange(task.messages_until_ns, -1);
  if (until < 0) return;
  const std::size_t bytes =
      hub_.Deliver(task.process->dds_number, std::max(until, task.cpu->progress_ns));
  task.reply[0] = static_cast<std::int64_t>(bytes);
}

}  // namespace tcs
