// The reference of an exchange: the least that two processes need to wait for each other.
#pragma once

namespace tcs::bench {

// TSC ticks of one round trip through two pipes between two processes under SCHED_FIFO on the
// caller's CPU, which must be the only one it may use. -1 where that is not permitted.
double PingPongTicks();

}  // namespace tcs::bench
