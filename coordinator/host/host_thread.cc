#include "coordinator/host/host_thread.h"

#include "shm/clock_page.h"

namespace tcs {

bool HostThread::HasOwnClock() const {
  const shm::ClockPage& page = slot_memory->clock;
  const std::uint64_t number = shm::DispatchNumber(DispatchWord());
  return grant.StandsIn(page) && shm::DispatchNumber(page.executed_adjust.load()) == number &&
         shm::DispatchNumber(page.waited_adjust.load()) == number;
}

}  // namespace tcs
