// What a run writes about itself while it goes (docs/RESULTS.md): the schedule trace, when clients
// were activated, and who had the processor when.
#include <algorithm>
#include <filesystem>
#include <system_error>

#include "coordinator/core/engine.h"

namespace tcs {

namespace {

// Whether the process's DDS samples are being handed over: whom this wakes, a sample has woken.
bool IsTakingSamples(const Process& process) {
  const Task* deliverer = process.deliverer;
  return deliverer != nullptr && deliverer->Awaits<awaited::Messages>() == nullptr;
}

ReleaseCause CauseOf(const Task& task, shm::WakeReason reason) {
  if (task.Awaits<awaited::Messages>() != nullptr) return ReleaseCause::kInput;
  if (reason == shm::WakeReason::kDeadline) return ReleaseCause::kTime;
  if (task.process->expired_ns != shm::kNeverNs) return ReleaseCause::kTime;
  if (reason == shm::WakeReason::kSignal) return ReleaseCause::kSignal;
  if (task.Awaits<awaited::Futex>() != nullptr) {
    return IsTakingSamples(*task.process) ? ReleaseCause::kInput : ReleaseCause::kThread;
  }
  const bool for_child = task.Awaits<awaited::Child>() != nullptr;
  return for_child ? ReleaseCause::kChild : ReleaseCause::kInput;
}

}  // namespace

std::string Engine::OpenRecords() {
  const std::string& directory = options_.output_directory;
  if (directory.empty()) return {};
  // It says that a run has ended, and that of an earlier one would say it of this one.
  std::error_code ignored;
  for (const char* file : {"/summary.json", "/unfinished.json"}) {
    std::filesystem::remove(directory + file, ignored);
  }
  std::string error = trace_.Open(directory + "/trace.json");
  if (error.empty()) error = world_.OpenCsv(directory + "/bodies.csv");
  if (error.empty()) {
    error = activation_log_.Open(directory + "/activations.csv", options_.counts_work);
  }
  if (error.empty()) error = dispatch_log_.Open(directory + "/dispatches.csv", !IsFixed());
  return error;
}

std::string Engine::CloseRecords() {
  const std::string errors[] = {trace_.Close(), activation_log_.Close(), dispatch_log_.Close(),
                                world_.CloseCsv(), CloseDds()};
  for (const std::string& error : errors) {
    if (!error.empty()) return error;
  }
  return {};
}

// So that what is left of a run that is killed ends shortly before.
void Engine::FlushRecords() {
  trace_.Flush();
  activation_log_.Flush();
  dispatch_log_.Flush();
  world_.FlushCsv();
}

// Children come and go, and take over the names of those that have gone.
int Engine::AddRow(const std::string& group, const std::string& name) {
  const auto [row, is_new] = rows_.try_emplace({group, name}, 0);
  if (is_new) {
    dispatch_log_.AddRow(name);
    row->second = trace_.AddRow(group, name);
  }
  return row->second;
}

// It waits no longer. What was due before the robot could look at it was due then.
void Engine::NoteReleased(Task& task, shm::WakeReason reason, std::int64_t at_ns) {
  Process& process = *task.process;
  Activation& activation = task.activation;
  activation.cause = CauseOf(task, reason);
  const bool by_deadline = reason == shm::WakeReason::kDeadline;
  const std::int64_t due_ns = by_deadline ? task.wait->deadline_ns : process.expired_ns;
  activation.release_ns = std::min(at_ns, due_ns);
  // A program's clock does not go back to the world's.
  if (IsCallback()) activation.release_ns = std::max(activation.release_ns, process.shown_ns);
  activation.start_ns = -1;
  activation.charged_ns = std::max(activation.charged_ns, task.charged_ns);
  if (task.slot >= 0) shm::NoteWoken(Slot(task).receipts);
}

// What the thread has done according to `seen`, the shim's count of it.
shm::WorkCounts Engine::WithTrapped(const Task& task, const shm::WorkCounts& seen) {
  return {seen.calls + task.trapped_calls, seen.locks};
}

// It did not wait, and is at its next activation all the same (shm/receipts.h).
void Engine::NoteNext(Task& task, std::int64_t now_ns, std::int64_t charged_ns,
                      const shm::WorkCounts& work, bool of_timer) {
  Activation& activation = task.activation;
  if (activation.start_ns < 0) activation.start_ns = activation.release_ns;
  now_ns = std::max(now_ns, activation.start_ns);
  charged_ns = std::max(charged_ns, activation.charged_ns);
  activation_log_.Write(task.process->name, task.is_further ? task.order : 0, activation, now_ns,
                        charged_ns, work);
  ++task.activations;
  activation = {of_timer ? ReleaseCause::kTime : ReleaseCause::kInput, now_ns, now_ns, charged_ns,
                work};
}

// What the thread has said of that since its dispatch, up to `now_ns` on its clock.
void Engine::TakeReceipts(Task& task, std::int64_t now_ns) {
  shm::Receipts& receipts = Slot(task).receipts;
  const std::uint32_t count = std::min(receipts.count.load(), shm::Receipts::kMost);
  for (std::uint32_t i = 0; i < count; ++i) {
    const shm::Receipts::Entry entry = receipts.entries[i];
    NoteNext(task, std::min(entry.time_ns, now_ns), std::min(entry.cpu_ns, task.charged_ns),
             WithTrapped(task, entry.work), entry.of == shm::Receipts::Of::kTimer);
  }
  receipts.count.store(0);
}

// The same of a call that the kernel is to carry out, and that finds something there.
void Engine::NoteReceivedRaw(Task& task, bool of_timer) {
  if (task.slot < 0 || !shm::NoteReceived(Slot(task).receipts, task.charged_ns)) return;
  NoteNext(task, task.reached_ns + task.process->frozen_ns, task.charged_ns, task.work, of_timer);
}

// It waits again, or has ended.
void Engine::NoteIdle(Task& task) {
  const std::int64_t now = task.reached_ns + task.process->frozen_ns;
  task.process->expired_ns = shm::kNeverNs;
  if (task.slot < 0) return;  // it never began
  if (task.activation.start_ns < 0) task.activation.start_ns = task.activation.release_ns;
  // What a switch takes is an estimate: one shorter than it gives back what was charged too much.
  // No activation is charged less than nothing for that; those that follow are charged less.
  const std::int64_t charged = std::max(task.charged_ns, task.activation.charged_ns);
  activation_log_.Write(task.process->name, task.is_further ? task.order : 0, task.activation,
                        std::max(now, task.activation.start_ns), charged, task.work);
  task.activation.charged_ns = charged;
  task.activation.work = task.work;
}

void Engine::RecordSlice(int row, std::int64_t start_ns, std::int64_t end_ns,
                         std::uint64_t since_tsc, std::uint64_t until_tsc) {
  if (!dispatch_log_.is_open()) return;
  const auto real = [this](std::uint64_t tsc) {
    return static_cast<std::int64_t>(static_cast<double>(tsc - start_tsc_) / ticks_per_ns_);
  };
  dispatch_log_.Slice(row, {start_ns, end_ns}, {real(since_tsc), real(until_tsc)});
}

}  // namespace tcs
