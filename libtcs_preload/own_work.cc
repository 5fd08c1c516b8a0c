#include "libtcs_preload/own_work.h"

#include <atomic>

#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

namespace {

// More than the shim works between two of the program's calls, or a handler of its own.
constexpr std::int64_t kMostNs = 10'000;

constexpr std::uint32_t kUnknown = ~0u;
constexpr int kTimesToMeasure = 6;

std::atomic<std::uint32_t> g_surplus_ticks{kUnknown};

// What is left to the thread of a call that does nothing.
std::uint64_t TicksOfPlainCall(GuestThread& thread) {
  const std::uint64_t begun_tsc = shm::ReadTsc(), begun_ticks = thread.own_work_ticks;
  {
    const OwnWork own(&thread);
    AsProgram(thread, [] { return RawSyscall(SYS_getppid); });
  }
  const std::uint64_t own_ticks = thread.own_work_ticks - begun_ticks;
  return shm::ReadTsc() - begun_tsc - own_ticks;
}

std::uint32_t MeasureSurplus(GuestThread& thread) {
  const std::uint64_t natively = g_header->plain_call_ticks;
  std::uint64_t least = ~std::uint64_t{0};
  for (int i = 0; i < kTimesToMeasure; ++i) {
    const std::uint64_t ticks = TicksOfPlainCall(thread);
    if (ticks < least) least = ticks;
  }
  return least > natively ? static_cast<std::uint32_t>(least - natively) : 0;
}

}  // namespace

std::uint64_t SurplusTicks(GuestThread& thread) {
  const std::uint32_t known = g_surplus_ticks.load(std::memory_order_relaxed);
  if (__builtin_expect(known != kUnknown, 1)) return known;
  g_surplus_ticks.store(0, std::memory_order_relaxed);
  if (g_header->plain_call_ticks == 0) return 0;
  TakeOutOwnWork(thread);
  // So that the measured calls begin work of their own.
  const std::uint64_t begun_tsc = thread.own_work_tsc, begun_ticks = thread.own_work_ticks;
  thread.own_work_tsc = 0;
  const std::uint32_t surplus = MeasureSurplus(thread);
  thread.own_work_tsc = begun_tsc + (thread.own_work_ticks - begun_ticks);
  g_surplus_ticks.store(surplus, std::memory_order_relaxed);
  return surplus;
}

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
    thread.own_work_ticks += static_cast<std::uint64_t>(ticks);
  }
  thread.own_work_tsc = now.tsc;
}

}  // namespace tcs::preload
