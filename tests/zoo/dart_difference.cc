#include "tests/zoo/dart_difference.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <random>
#include <vector>

#include "tests/unit/engines/dart_robot.h"
#include "tests/zoo/free_motion.h"

namespace tcs::zoo {

namespace {

// Steps in 1 s: explicit ones, which a light finger that spins, or a strong damper, makes short.
constexpr int kFewestSteps = 5'000, kMostSteps = 80'000, kTimesMore = 4;
// What more steps change by less than this is known.
constexpr double kKnown = 1e-6;

std::vector<double> PositionsOf(const DartRobot& robot, const RobotModel& model) {
  std::vector<double> positions;
  for (const Joint& joint : model.joints) {
    if (CoordinatesOf(joint.kind) == 1) positions.push_back(robot.PositionOf(joint.name));
  }
  return positions;
}

double MostApart(const std::vector<double>& some, const std::vector<double>& others) {
  double most = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    most = std::max(most, std::abs(some[i] - others[i]));
  }
  return most;
}

}  // namespace

std::optional<double> DifferenceToDart(const std::string& urdf, const std::string& packages,
                                       const RobotModel& model) {
  try {
    std::mt19937_64 random(3);
    const RobotModel smooth = SmoothModel(model, random);
    std::vector<double> before;
    for (int steps = kFewestSteps; steps <= kMostSteps; steps *= kTimesMore) {
      DartRobot known(urdf, packages, smooth, {0, 0, -9.81});
      known.Advance(1, steps);
      const std::vector<double> positions = PositionsOf(known, smooth);
      const bool is_known = !before.empty() && MostApart(before, positions) < kKnown;
      before = positions;
      if (!is_known) continue;
      const auto position_of = [&known](const Joint& joint) {
        return known.PositionOf(joint.name);
      };
      return ApartFrom(position_of, smooth, EngineKind::kSimbody, VirtualDuration::Seconds(1)).most;
    }
  } catch (const std::exception&) {
  }
  return std::nullopt;
}

}  // namespace tcs::zoo
