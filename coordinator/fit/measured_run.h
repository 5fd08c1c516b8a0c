// The work and the charges of a run's clients, as its result folder tells them: summary.json and
// activations.csv of `tcsim run --for-fit`.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "coordinator/errors/load_error.h"
#include "coordinator/fit/costs.h"

namespace tcs::fit {

struct MeasuredClient {
  double speed = 1;  // of the client's robot, to the host's
  Work whole;
  std::vector<Work> activations;  // all that had ended by the run's end
};

struct MeasuredRun {
  std::string folder, scenario;
  std::map<std::string, MeasuredClient> clients;  // by ROBOT/CLIENT
  std::vector<std::string> warnings;
};

// The error says what to do about a folder that nothing can be fitted to.
[[nodiscard]] LoadResult<MeasuredRun> ReadMeasuredRun(const std::string& folder);

}  // namespace tcs::fit
