#include "coordinator/answers/response.h"

namespace tcs {

std::int64_t TimeParts::TotalNs() const {
  std::int64_t total_ns = queued_ns + away_ns + executed_ns + room_ns;
  for (const auto& [client, ns] : cores_ns) total_ns += ns;
  for (const auto& [client, ns] : locks_ns) total_ns += ns;
  return total_ns;
}

}  // namespace tcs
