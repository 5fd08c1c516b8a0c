#include "coordinator/calls/date_calls.h"

#include <errno.h>
#include <linux/capability.h>

#include <algorithm>

#include "coordinator/port/proc_files.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

// The kernel keeps so much for the time that the computer may still run.
constexpr std::int64_t kLatestDateNs =
    INT64_MAX - std::int64_t{30} * 365 * 24 * 3600 * shm::kNsPerSecond;

}  // namespace

std::int64_t DateCalls::Set(Task& task, std::int64_t date_ns) {
  const std::int64_t now_ns = OwnNow(task).ns();
  if (date_ns < 0 || date_ns > kLatestDateNs) return -EINVAL;
  if (!ReadCredentials(task.tid).Has(CAP_SYS_TIME) || run_.robots.size() > 1) return -EPERM;
  // Not before the computer was started.
  if (date_ns < now_ns + run_.header->monotonic_offset_ns) return -EINVAL;
  std::int64_t offset_ns = date_ns - now_ns;
  if (offset_ns == 0) offset_ns = 1;  // which would say that there is none
  const std::int64_t before_ns = run_.header->realtime_offset_ns.exchange(offset_ns);
  if (!run_.first_realtime_offset_ns.has_value()) run_.first_realtime_offset_ns = before_ns;
  const std::int64_t forward_ns = offset_ns - before_ns;
  for (Task& other : run_.table.tasks()) {
    if (!other.wait.has_value() || !other.wait->is_date || other.wait->deadline.IsNever()) continue;
    const VirtualTime moved = RobotTime(shm::AddSaturated(other.wait->deadline.ns(), -forward_ns));
    waker_.MoveDeadline(other, std::max(moved, task.reached));
  }
  for (Process& process : run_.table.processes()) {
    if (!process.dead) process.timers.MoveDates(forward_ns, task.reached);
  }
  return 0;
}

}  // namespace tcs
