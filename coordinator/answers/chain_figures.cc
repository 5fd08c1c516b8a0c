#include "coordinator/answers/chain_figures.h"

namespace tcs {

std::string NameOf(const ChainHop& hop) {
  switch (hop.of) {
    case ChainHop::Of::kSensor:
    case ChainHop::Of::kActuator:
      return "the latency of " + hop.name;
    case ChainHop::Of::kWaiting:
      return "waiting for " + hop.name;
    case ChainHop::Of::kProgram:
      return hop.name;
    case ChainHop::Of::kHeld:
      return hop.name + " having nothing newer";
    case ChainHop::Of::kWay:
      return "the way from " + hop.name;
  }
  return "";
}

}  // namespace tcs
