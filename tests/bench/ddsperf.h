// One measurement of Cyclone DDS's own benchmark, Debian's ddsperf, unmodified: two processes of
// it, which send each other samples for two seconds of their own clocks.
#pragma once

#include <optional>
#include <string>

namespace tcs::bench {

// What carries the samples. Natively the kernel's loopback, in real time, on all CPUs that
// tcs_bench may use; under tcs one robot with two cores, Cyclone's own protocol over virtual
// sockets, or samples in shared memory.
enum class Carrier { kNative, kSockets, kEndpoints };

enum class Exchange {
  kListener,    // ping and pong, each as soon as the one before is there, taken by listeners
  kWaitset,     // the same by threads that wait for them
  kThroughput,  // one writes as fast as it can, the other one takes by a listener
};

struct DdsperfCase {
  std::string size;  // of a sample, as ddsperf wants it
  Exchange exchange = Exchange::kListener;
};

struct DdsperfNumbers {
  // By ddsperf's own clock. One way: half a round trip.
  double mean_us = 0, median_us = 0;
  double samples_per_second = 0;  // of the last second, when both have long found each other
  // Of the host, for 100,000 round trips or samples.
  double real_seconds = 0, cpu_seconds = 0;
};

// The network and the environment that all of them are run in, from here on for the calling
// process, which must be the only thread. Where no network of its own can be had, programs of other
// users are kept away by an unusual DDS domain only.
void PrepareForDdsperf();

// None, with a sentence on stderr, if it could not be had. `gently`: at a low rate, so that it
// takes little of the host.
std::optional<DdsperfNumbers> RunDdsperf(const DdsperfCase& what, Carrier carrier, bool gently);

}  // namespace tcs::bench
