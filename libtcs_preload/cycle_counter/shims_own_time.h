// Time that the shim computes for itself, and that is not the program's.
#pragma once

#include <cstdint>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

// The thread is not charged for what it computes while this object lives, as far as it does so in
// one dispatch.
class ShimsOwnTime {
 public:
  ShimsOwnTime();
  ~ShimsOwnTime();
  ShimsOwnTime(const ShimsOwnTime&) = delete;
  ShimsOwnTime& operator=(const ShimsOwnTime&) = delete;

 private:
  GuestThread* const thread_;
  std::uint64_t dispatch_ = 0;
  std::int64_t begun_cpu_ns_ = 0;
};

}  // namespace tcs::preload
