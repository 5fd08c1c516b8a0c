// When things happen. Times are dds_time(), which is CLOCK_REALTIME. What waits for a time never
// ends before it, natively as under tcs; how late it may be depends on what carries the samples.
#pragma once

#include <stdlib.h>

#include "tests/dds/support/process.h"

namespace dds_test {

// What the threads on the way may have computed, in virtual time: with set costs (TCS_DDS_SET_COSTS
// is set), and where it is measured, of a slow host that is busy.
inline dds_duration_t MostComputing() {
  return getenv("TCS_DDS_SET_COSTS") != nullptr ? DDS_MSECS(1) : DDS_MSECS(10);
}

// `moment` was due at `due`. It may be late natively, and where processes share a core
// (TCS_DDS_SHARED_CORE is set), for they wait for each other's turns.
inline void CheckLateness(const char* what, dds_time_t moment, dds_time_t due, bool exact) {
  const long long late_ns = moment - due;
  if (late_ns < 0) Fail("%s was %lld ns early", what, -late_ns);
  if (exact && getenv("TCS_DDS_SHARED_CORE") == nullptr && late_ns > MostComputing())
    Fail("%s was %lld ns late", what, late_ns);
}

// For what a protocol that carries the samples may delay.
inline void CheckDue(const Process& self, const char* what, dds_time_t moment, dds_time_t due) {
  CheckLateness(what, moment, due, self.under == Under::kEndpoints);
}

// For what no sample has to travel for: exact wherever time is virtual.
inline void CheckOwnDue(const Process& self, const char* what, dds_time_t moment, dds_time_t due) {
  CheckLateness(what, moment, due, self.under != Under::kNative);
}

}  // namespace dds_test
