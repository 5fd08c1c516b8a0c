#include "libtcs_preload/cycle_counter/shims_own_time.h"

#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/virtual_clock.h"

namespace tcs::preload {

namespace {

constexpr std::int64_t kMostNs = 100'000'000;

std::int64_t OwnCpuNs() {
  timespec cpu;
  RawSyscall(SYS_clock_gettime, CLOCK_THREAD_CPUTIME_ID, Arg(&cpu));
  return ToNs(cpu);
}

std::uint64_t DispatchOf(const GuestThread& thread) {
  return shm::DispatchNumber(thread.slot->clock.executed_adjust.load());
}

}  // namespace

ShimsOwnTime::ShimsOwnTime() : thread_(IfAttached()) {
  if (thread_ == nullptr) return;
  dispatch_ = DispatchOf(*thread_);
  begun_cpu_ns_ = OwnCpuNs();
}

ShimsOwnTime::~ShimsOwnTime() {
  if (thread_ == nullptr) return;
  shm::ClockPage& page = thread_->slot->clock;
  const std::int64_t own_ns = OwnCpuNs() - begun_cpu_ns_;
  const shm::ClockReading now = shm::ReadClock(page);
  if (shm::DispatchNumber(now.executed_word) != dispatch_) return;
  shm::TakeOut(page, now, shm::MulQ32(own_ns, page.ns_per_host_ns_q32), kMostNs);
}

}  // namespace tcs::preload
