// Two threads that hand the turn to each other by a condition variable.
#pragma once

namespace tcs::bench {

// Ticks of one handover, there or back; negative where SCHED_FIFO is not permitted.
double HandoverTicks();

}  // namespace tcs::bench
