// `tcsim trials`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/trials/plan.h"

namespace tcs {

struct TrialsArguments {
  std::string scenario = "scenario.yaml", out = "trials", name;
  int trials = 0;
  int jobs = 0;  // 0: as many as there is room for
  std::optional<std::uint64_t> first_seed;
  bool restart = false, host_network = false, no_wait = false;
  bool strict = false;                // each warning is an error
  std::string junit;                  // a file for the judgement; empty: none
  std::vector<std::string> vary;      // KEY=V1,V2
  std::vector<std::string> overlays;  // files
  std::string launcher = "local";     // or "slurm"
  std::vector<std::string> slurm_options;
  TrialOptions options;
};

// The exit status. The command guards itself: whatever dies, no run of the command is left.
int TrialsCommand(const TrialsArguments& arguments);

}  // namespace tcs
