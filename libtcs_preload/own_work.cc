#include "libtcs_preload/own_work.h"

namespace tcs::preload {

namespace {

// More than the shim works between two of the program's calls, or a handler of its own.
constexpr std::int64_t kMostNs = 10'000;

}  // namespace

void TakeOutOwnWork(GuestThread& thread) {
  if (thread.own_work_tsc == 0) return;
  shm::ClockPage& page = thread.slot->clock;
  const shm::ClockReading now = shm::ReadClock(page);
  // What came before the thread's present turn has been settled.
  const std::uint64_t begun_tsc =
      thread.own_work_tsc > page.base_tsc ? thread.own_work_tsc : page.base_tsc;
  // Not where a look that was the program's call has put it off.
  if (now.tsc > begun_tsc) {
    const auto ticks = static_cast<std::int64_t>(now.tsc - begun_tsc);
    shm::TakeOut(page, now, shm::MulQ32(ticks, page.ns_per_tick_q32), kMostNs);
  }
  thread.own_work_tsc = now.tsc;
}

}  // namespace tcs::preload
