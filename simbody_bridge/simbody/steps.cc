#include "simbody_bridge/simbody/steps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simbody_bridge/simbody/model.h"

namespace tcs {
namespace {

constexpr VirtualDuration kLongestStep = VirtualDuration::Seconds(1000);

}  // namespace

std::string OnOneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// Error control sees a wall only where it evaluates the forces. A body that reaches a wall is in it
// for half a period of the swing that the wall would make of its motion; less only where something
// else pushes it back at once, and then the wall has hardly touched it. So no step is longer than a
// quarter of that.
VirtualDuration LongestStepBeside(const WorldSpec& world, const std::vector<int>& bodies) {
  if (!world.has_region || world.region.stiffness_npm <= 0) return kLongestStep;
  double longest_s = kLongestStep.seconds();
  for (const int body : bodies) {
    const double mass_kg = world.bodies[static_cast<std::size_t>(body)].mass_kg;
    const double half_period_s = std::numbers::pi * std::sqrt(mass_kg / world.region.stiffness_npm);
    longest_s = std::min(longest_s, half_period_s / 4);
  }
  return std::max(VirtualDuration::Nanoseconds(1),
                  VirtualDuration::Nanoseconds(static_cast<std::int64_t>(longest_s * 1e9)));
}

void InterpolateNumbers(const IslandStep& step, double after_s, std::vector<double>* state) {
  const double h = step.length_s, d = after_s / h;
  const double to = d * d * (3 - 2 * d), from = 1 - to;
  const double from_rate = h * d * (1 - d) * (1 - d), to_rate = -h * d * d * (1 - d);
  state->resize(step.from.size());
  for (std::size_t i = 0; i < state->size(); ++i) {
    (*state)[i] = from * step.from[i] + to * step.to[i] + from_rate * step.from_rate[i] +
                  to_rate * step.to_rate[i];
  }
}

void Interpolate(const IslandStep& step, double after_s, std::vector<double>* state) {
  InterpolateNumbers(step, after_s, state);
  NormaliseQuaternions(*state, static_cast<int>(step.wrenches.size()));
}

Masses MassesOf(const WorldSpec& world, const std::vector<int>& bodies) {
  Masses masses;
  for (const int index : bodies) {
    const BodySpec& body = world.bodies[static_cast<std::size_t>(index)];
    masses.emplace_back(body.mass_kg, body.inertia_kgm2);
  }
  return masses;
}

}  // namespace tcs
