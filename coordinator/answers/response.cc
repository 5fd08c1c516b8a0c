#include "coordinator/answers/response.h"

namespace tcs {

std::int64_t TimeParts::TotalNs() const {
  return queued_ns + away_ns + wakeup_ns + executed_ns + room_ns + cores_ns.TotalNs() +
         locks_ns.TotalNs();
}

}  // namespace tcs
