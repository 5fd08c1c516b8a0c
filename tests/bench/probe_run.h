// One measurement: tcs_bench_probe, started in one of the three worlds.
#pragma once

#include <optional>
#include <string>

namespace tcs::bench {

enum class World { kNative, kFaketime, kTcs };

struct Probe {
  std::string what;  // the probe's word for it
  World world = World::kNative;
  std::string steps = "0";  // of `work`; of `explored`: seconds
};

// The probe's number; none, with a sentence on stderr, if it could not be had.
std::optional<double> RunProbe(const Probe& probe);

}  // namespace tcs::bench
