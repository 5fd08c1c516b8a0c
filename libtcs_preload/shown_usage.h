// The processor time that getrusage and wait4 tell of.
#pragma once

#include <sys/resource.h>

#include <cstdint>

#include "libtcs_preload/virtual_clock.h"

namespace tcs::preload {

// Puts the charge in the place of what the host has measured. The kernel's split into user and
// system time is kept as a proportion; under set costs, which repeat, all is user time.
inline void ChargeInsteadOfMeasure(rusage* usage, std::int64_t charged_ns) {
  const std::int64_t user = ToNs(usage->ru_utime), system = ToNs(usage->ru_stime);
  const bool is_fixed = g_header->accounting == shm::Accounting::kFixed;
  const double user_part = is_fixed || user + system == 0
                               ? 1.0
                               : static_cast<double>(user) / static_cast<double>(user + system);
  const auto charged_user = static_cast<std::int64_t>(static_cast<double>(charged_ns) * user_part);
  usage->ru_utime = ToTimeval(charged_user);
  usage->ru_stime = ToTimeval(charged_ns - charged_user);
}

}  // namespace tcs::preload
