#include "simbody_bridge/take_steps.h"

#include <fmt/format.h>

#include "simbody_bridge/island.h"
#include "simbody_bridge/model/finite.h"
#include "simbody_bridge/one_line.h"

namespace tcs {
namespace {

[[noreturn]] void ThrowDiverged(const std::string& who, double by_s) {
  throw DynamicsError(fmt::format("{}: its motion has diverged by {:.12g} s", who, by_s));
}

// With steps of a set length engines take whatever comes out of one, and stumble over it only in
// the next.
void Check(const IslandStep& step, const WhoDiverged& who) {
  CheckState(step.island, step.from, step.at, who);
  const double from_s = step.at.seconds();
  if (!AllFinite(step.to) || !AllFinite(step.to_rate)) {
    ThrowDiverged(who(step.island, step.to), from_s + step.length_s);
  }
  if (LengthOf(step) > VirtualDuration{}) return;
  throw DynamicsError(fmt::format(
      "the integration from {:.12g} s on failed: the integrator makes no progress", from_s));
}

// One of the steps cannot be taken: to say which, and whose it is.
void TakeEachStep(IslandEngine& engine, std::span<IslandStep* const> steps,
                  const WhoDiverged& who) {
  for (IslandStep* step : steps) {
    try {
      engine.Take(*step);
    } catch (const DynamicsError&) {
      throw;
    } catch (const std::exception& e) {
      throw DynamicsError(fmt::format("the integration from {:.12g} s on failed: {}",
                                      step->at.seconds(), OnOneLine(e.what())));
    }
    Check(*step, who);
  }
}

}  // namespace

void CheckState(int island, std::span<const double> state, VirtualTime t, const WhoDiverged& who) {
  if (!AllFinite(state)) ThrowDiverged(who(island, state), t.seconds());
}

void TakeSteps(IslandEngine& engine, std::span<IslandStep* const> steps, const WhoDiverged& who) {
  try {
    engine.TakeAll(steps);
    for (const IslandStep* step : steps) Check(*step, who);
  } catch (const std::exception&) {
    TakeEachStep(engine, steps, who);
  }
}

}  // namespace tcs
