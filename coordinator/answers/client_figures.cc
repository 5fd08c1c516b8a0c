#include "coordinator/answers/client_figures.h"

namespace tcs {

void ActivationTimes::Add(const ActivationTimes& others) {
  response.Add(others.response);
  start_delay.Add(others.start_delay);
  execution.Add(others.execution);
}

}  // namespace tcs
