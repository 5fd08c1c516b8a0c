#include "simbody_bridge/simbody/steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "simbody_bridge/air.h"
#include "simbody_bridge/simbody/model.h"

namespace tcs {
namespace {

// A body that reaches a wall is in it for half a period of the swing that the wall would make of
// its motion; less only where something else pushes it back at once, and then the wall has hardly
// touched it.
double TimeInWall(const WorldSpec& world, const BodySpec& body) {
  if (!world.has_region || world.region.stiffness_npm <= 0)
    return std::numeric_limits<double>::infinity();
  return std::numbers::pi * std::sqrt(body.mass_kg / world.region.stiffness_npm);
}

// Half a period of the fastest tone.
double TimeOfGust(const WorldSpec& world, const BodySpec& body) {
  const double fastest_radps = FastestGustRadps(world.wind);
  if (fastest_radps == 0 || body.drag == DragSpec{}) return std::numeric_limits<double>::infinity();
  return std::numbers::pi / fastest_radps;
}

}  // namespace

// Error control sees a wall or a gust only where it evaluates the forces. So no step is longer than
// a quarter of the time that the wall or the gust takes.
VirtualDuration LongestStepBeside(const WorldSpec& world, const std::vector<int>& bodies) {
  double brief_s = std::numeric_limits<double>::infinity();
  for (const int index : bodies) {
    const BodySpec& body = world.bodies[static_cast<std::size_t>(index)];
    brief_s = std::min({brief_s, TimeInWall(world, body), TimeOfGust(world, body)});
  }
  if (brief_s / 4 >= kLongestStep.seconds()) return kLongestStep;
  return std::max(VirtualDuration::Nanoseconds(1),
                  VirtualDuration::Nanoseconds(static_cast<std::int64_t>(brief_s / 4 * 1e9)));
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

void TakeShortened(IslandEngine& engine, const IslandStep& step, VirtualDuration after,
                   IslandStep* memory, std::vector<double>* state) {
  *memory = step;
  memory->limit = after;
  engine.Take(*memory);
  *state = memory->to;
}

}  // namespace tcs
