// The processor that everything is measured on.
#pragma once

namespace tcs::bench {

// Binds the calling process, and so whatever it starts, to the last CPU it may use: the one that
// tcsim chooses, too.
bool BindToLastCpu();

// Real nanoseconds per TSC tick, measured for some 50 ms.
double NsPerTick();

}  // namespace tcs::bench
