// Real cost of calls that tcs answers, in TSC ticks per call.
#pragma once

namespace tcs::bench {

double ClockReadTicks();
// One microsecond; under tcs it ends inside the horizon, where the shim answers it by itself.
double ShortSleepTicks();
// sched_yield with nobody to yield to; under tcs exactly one exchange with the coordinator.
double ExchangeTicks();

// Locks and unlocks a mutex that nobody else wants.
double MutexTicks();

// A system call that is not trapped.
double KernelCallTicks();

}  // namespace tcs::bench
