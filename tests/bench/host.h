// The processor that calls and computing are measured on.
#pragma once

namespace tcs::bench {

// Binds the calling process, and so whatever it starts, to the last CPU it may use: the one that
// tcsim chooses, too.
bool BindToLastCpu();
// While it lives, this process may use all that it might before BindToLastCpu, and so may the runs
// that it starts: how many processors these have is theirs to say.
class OnAllCpus {
 public:
  OnAllCpus();
  ~OnAllCpus();
  OnAllCpus(const OnAllCpus&) = delete;
  OnAllCpus& operator=(const OnAllCpus&) = delete;
};

// How many CPUs the calling process may use.
unsigned AllowedCpus();

// Real nanoseconds per TSC tick, measured for some 50 ms.
double NsPerTick();

}  // namespace tcs::bench
