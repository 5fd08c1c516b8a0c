// One direction of a serial line, which takes the time of its bits for each byte.
#pragma once

#include <cstdint>

#include "shm/virtual_time.h"

namespace tcs {

class SerialLine {
 public:
  // `bits` of a byte with all that frames it: 10 for 8N1.
  SerialLine(int bits, int baud) : bits_(bits), baud_(baud) {}

  // Sends one more byte, which is there to be sent at `from`. Returns the time at which the byte's
  // last bit has gone, in whole nanoseconds rounded up. Bytes that follow each other do not add up
  // their rounding.
  VirtualTime Send(VirtualTime from) {
    if (from >= free_) {
      burst_ = from;
      count_ = 0;
    }
    return free_ = burst_ + TimeOf(++count_);
  }

  VirtualDuration TimeOf(std::int64_t bytes) const {
    const std::int64_t all = bytes * bits_, rest_ns = all % baud_ * 1'000'000'000;
    return VirtualDuration::Seconds(all / baud_) +
           VirtualDuration::Nanoseconds((rest_ns + baud_ - 1) / baud_);
  }

  // The time at which all bytes that were given to the line have gone.
  VirtualTime free_at() const { return free_; }

 private:
  int bits_, baud_;
  VirtualTime burst_, free_;
  std::int64_t count_ = 0;  // of bytes since the line was last free
};

}  // namespace tcs
