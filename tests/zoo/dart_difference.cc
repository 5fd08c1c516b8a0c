#include "tests/zoo/dart_difference.h"

#include <exception>
#include <random>

#include "tests/unit/engines/dart_robot.h"
#include "tests/zoo/free_motion.h"

namespace tcs::zoo {

std::optional<double> DifferenceToDart(const std::string& urdf, const std::string& packages,
                                       const RobotModel& model) {
  try {
    std::mt19937_64 random(3);
    const RobotModel smooth = SmoothModel(model, random);
    DartRobot known(urdf, packages, smooth, {0, 0, -9.81});
    known.Advance(1, 5'000);
    const auto position_of = [&known](const Joint& joint) { return known.PositionOf(joint.name); };
    return ApartFrom(position_of, smooth, EngineKind::kSimbody, VirtualDuration::Seconds(1)).most;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace tcs::zoo
