// When things happen. Times are dds_time(), which is CLOCK_REALTIME. What waits for a time never
// ends before it, natively as under tcs; how late it may be depends on what carries the samples.
#pragma once

#include "tests/dds/support/process.h"

namespace dds_test {

// What the threads on the way may have computed, in virtual time.
constexpr dds_duration_t kComputing = DDS_MSECS(1);

// `moment` was due at `due`, for reasons that samples carried by a protocol may delay.
inline void CheckDue(const Process& self, const char* what, dds_time_t moment, dds_time_t due) {
  const long long late_ns = moment - due;
  if (late_ns < 0) Fail("%s was %lld ns early", what, -late_ns);
  if (self.under == Under::kEndpoints && late_ns > kComputing)
    Fail("%s was %lld ns late", what, late_ns);
}

// The same for what no sample has to travel for: exact wherever time is virtual.
inline void CheckOwnDue(const Process& self, const char* what, dds_time_t moment, dds_time_t due) {
  const long long late_ns = moment - due;
  if (late_ns < 0) Fail("%s was %lld ns early", what, -late_ns);
  if (self.under != Under::kNative && late_ns > kComputing)
    Fail("%s was %lld ns late", what, late_ns);
}

}  // namespace dds_test
