#include "coordinator/host/clock_grant.h"

#include <algorithm>

namespace tcs {

void ClockGrant::WriteTo(shm::ClockPage& page) const {
  page.base_time_ns = base_time_ns;
  page.base_cpu_ns = base_cpu_ns;
  page.horizon_ns = horizon_ns;
  page.idle_until_ns = idle_until_ns;
  page.read_safe_ns = read_safe_ns;
  page.write_safe_ns = write_safe_ns;
  page.local_read_safe_ns = local_read_safe_ns;
  page.ns_per_host_ns_q32 = ns_per_host_ns_q32;
  page.ns_per_tick_q32 = ns_per_tick_q32;
  page.check_after_ticks = check_after_ticks;
  page.call_cost_ns = call_cost_ns;
  page.allocation_cost_ns = allocation_cost_ns;
  page.counts_work = counts_work;
}

bool ClockGrant::StandsIn(const shm::ClockPage& page) const {
  return page.base_time_ns == base_time_ns && page.base_cpu_ns == base_cpu_ns &&
         page.base_tsc == base_tsc && page.horizon_ns == horizon_ns &&
         page.idle_until_ns == idle_until_ns && page.read_safe_ns == read_safe_ns &&
         page.write_safe_ns == write_safe_ns && page.local_read_safe_ns == local_read_safe_ns &&
         page.ns_per_host_ns_q32 == ns_per_host_ns_q32 && page.ns_per_tick_q32 == ns_per_tick_q32 &&
         page.check_after_ticks == check_after_ticks && page.call_cost_ns == call_cost_ns &&
         page.allocation_cost_ns == allocation_cost_ns && page.counts_work == counts_work;
}

void ClockGrant::NoteLimits() {
  most_shown_ns = std::max(most_shown_ns, horizon_ns);
  most_stale_ns = std::max(most_stale_ns, horizon_ns - read_safe_ns);
}

}  // namespace tcs
