#include "simbody_bridge/take_steps.h"

#include <fmt/format.h>

#include "simbody_bridge/island.h"
#include "simbody_bridge/model/finite.h"

namespace tcs {
namespace {

using Who = std::function<std::string(const IslandStep&)>;

// With steps of a set length engines take whatever comes out of one, and stumble over it only in
// the next.
void Check(const IslandStep& step, const Who& who) {
  const double from_s = step.at.seconds();
  if (AllFinite(step.to) && AllFinite(step.to_rate)) {
    if (LengthOf(step) > VirtualDuration{}) return;
    throw DynamicsError(fmt::format(
        "the integration from {:.12g} s on failed: the integrator makes no progress", from_s));
  }
  throw DynamicsError(
      fmt::format("{}: its motion has diverged by {:.12g} s", who(step), from_s + step.length_s));
}

// One of the steps cannot be taken: to say which, and whose it is.
void TakeEachStep(IslandEngine& engine, std::span<IslandStep* const> steps, const Who& who) {
  for (IslandStep* step : steps) {
    try {
      engine.Take(*step);
    } catch (const DynamicsError&) {
      throw;
    } catch (const std::exception& e) {
      throw DynamicsError(fmt::format("the integration from {:.12g} s on failed: {}",
                                      step->at.seconds(), e.what()));
    }
    Check(*step, who);
  }
}

}  // namespace

void TakeSteps(IslandEngine& engine, std::span<IslandStep* const> steps, const Who& who) {
  try {
    engine.TakeAll(steps);
    for (const IslandStep* step : steps) Check(*step, who);
  } catch (const std::exception&) {
    TakeEachStep(engine, steps, who);
  }
}

}  // namespace tcs
