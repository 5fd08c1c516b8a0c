#include "coordinator/processes/usage_book.h"

#include "coordinator/port/clocks.h"
#include "coordinator/tasks/cpu_clock.h"

namespace tcs {

namespace {

// What is charged without being computed has moved the origin.
std::int64_t OriginOf(const Task& task) {
  return task.metered.host_origin_ns + task.metered.OnHost(task.priced).ns();
}

// The time that the thread has used, by its own CPU clock, since it was first charged; 0 where the
// clock can no longer be asked.
std::int64_t HostCpuOf(Task& task) {
  if (!task.metered.has_origin()) return 0;
  const std::int64_t now = HostClockOf(task);
  return now < 0 ? 0 : now - OriginOf(task);
}

}  // namespace

VirtualDuration UsageBook::ChargedTo(const Process& process) {
  VirtualDuration charged = VirtualNs(process.ended.usage().charged_ns);
  for (const Task* task : process.robot->tasks) {
    if (task->process == &process) charged += task->charged;
  }
  return charged;
}

VirtualDuration UsageBook::ChargedToAllOf(const Process& client) const {
  VirtualDuration charged = VirtualNs(client.descendants.charged_ns);
  for (const Process& process : table_.processes()) {
    if (process.client != &client || (process.dead && !process.is_client)) continue;
    charged += ChargedTo(process);
  }
  return charged;
}

Usage UsageBook::UsageOf(const Process& process) const {
  Usage usage = process.ended.usage();
  for (Task* task : process.robot->tasks) {
    if (task->process != &process || task->slot < 0) continue;
    usage += {.charged_ns = task->charged.ns(),
              .priced_ns = task->priced.ns(),
              .host_cpu_ns = HostCpuOf(*task),
              .own_work_ns = task->metered.own_work_in_all.ns(),
              .stolen_ns = check_.StolenOf(*task),
              .activations = task->activations,
              .work = task->work};
  }
  return usage;
}

Usage UsageBook::UsageOfAll(const Process& client) const {
  Usage usage = client.descendants;
  for (const Process& process : table_.processes()) {
    // The usage of other ended processes is kept already, and their places may be others'.
    if (process.client != &client || (process.dead && !process.is_client)) continue;
    usage += UsageOf(process);
  }
  return usage;
}

void UsageBook::Keep(Task& ended) const {
  Process& process = *ended.process;
  const Usage usage{
      .charged_ns = ended.charged.ns(),
      .priced_ns = ended.priced.ns(),
      .own_work_ns = ended.metered.own_work_in_all.ns(),
      .stolen_ns = ended.slot < 0 ? 0 : check_.StolenOf(ended),
      .activations = ended.activations,
      .work = ended.work,
  };
  if (!ended.metered.has_origin()) {  // the thread never ran under its clock
    process.ended.Add(usage, 0, 0, 0);
    return;
  }
  const std::int64_t fallback_ns = ended.metered.OnHost(ended.charged - ended.priced).ns();
  process.ended.Add(usage, HostClockOf(ended), OriginOf(ended), fallback_ns);
}

void UsageBook::Keep(Process& ended) {
  ended.ended.Complete(ProcessCpuClockNs(ended.pid));
  if (ended.client != nullptr && !ended.is_client) {
    ended.client->descendants += ended.ended.usage();
  }
}

}  // namespace tcs
