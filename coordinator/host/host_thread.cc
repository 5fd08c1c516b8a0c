#include "coordinator/host/host_thread.h"

#include "shm/clock_page.h"

namespace tcs {

bool HostThread::IsOwn(const shm::ClockPage& page) const {
  const std::uint64_t number = shm::DispatchNumber(DispatchWord());
  return grant.StandsIn(page) && shm::DispatchNumber(page.executed_adjust.load()) == number &&
         shm::DispatchNumber(page.waited_adjust.load()) == number;
}

}  // namespace tcs
