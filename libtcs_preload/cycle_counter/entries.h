// Where reads of the cycle counter are led to: the virtual counter.
//
// The virtual counter goes on at one rate with CLOCK_MONOTONIC of the virtual time, so it shows the
// same in all threads, and a read costs what a read of that clock costs.
#pragma once

// Called in the midst of other people's functions, in place of the instruction: all registers but
// those that the instruction writes are preserved, flags and vectors too. 128 bytes below the stack
// pointer are the caller's, which has gone below them. Async-signal-safe; take 600 bytes of the
// stack, besides what a wait takes.
extern "C" {
__attribute__((visibility("hidden"))) void tcs_read_counter();                // for rdtsc
__attribute__((visibility("hidden"))) void tcs_read_counter_and_processor();  // for rdtscp
}
