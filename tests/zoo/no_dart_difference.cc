#include "tests/zoo/dart_difference.h"

namespace tcs::zoo {

std::optional<double> DifferenceToDart(const std::string& /*urdf*/, const std::string& /*packages*/,
                                       const RobotModel& /*model*/) {
  return std::nullopt;
}

}  // namespace tcs::zoo
