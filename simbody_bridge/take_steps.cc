#include "simbody_bridge/take_steps.h"

#include <fmt/format.h>

#include "simbody_bridge/island.h"
#include "simbody_bridge/model/finite.h"
#include "simbody_bridge/one_line.h"

namespace tcs {
namespace {

[[noreturn]] void ThrowDiverged(IslandEngine& engine, int island, const std::string& who,
                                double by_s) {
  throw DynamicsError(fmt::format("{}: its motion has diverged by {:.12g} s{}", who, by_s,
                                  RemedyFor(engine, island)));
}

// With steps of a set length engines take whatever comes out of a step, and stumble over it only in
// the next.
void Check(IslandEngine& engine, const IslandStep& step, const WhoDiverged& who) {
  CheckState(engine, step.island, step.from, step.at, who);
  const double from_s = step.at.seconds();
  if (!AllFinite(step.to) || !AllFinite(step.to_rate)) {
    ThrowDiverged(engine, step.island, who(step.island, step.to), from_s + step.length_s);
  }
  if (LengthOf(step) > VirtualDuration{}) return;
  throw DynamicsError(fmt::format(
      "the integration from {:.12g} s on failed: the integrator makes no progress", from_s));
}

// One of the steps cannot be taken: takes each step alone, to say which step that is, and whose.
void TakeEachStep(IslandEngine& engine, std::span<IslandStep* const> steps,
                  const WhoDiverged& who) {
  for (IslandStep* step : steps) {
    try {
      engine.Take(*step);
    } catch (const DynamicsError&) {
      throw;
    } catch (const std::exception& e) {
      throw DynamicsError(fmt::format("{}: the integration from {:.12g} s on failed: {}{}",
                                      who(step->island, step->from), step->at.seconds(),
                                      OnOneLine(e.what()), RemedyFor(engine, step->island)));
    }
    Check(engine, *step, who);
  }
}

}  // namespace

std::string RemedyFor(IslandEngine& engine, int island) {
  const std::string suspect = engine.SuspectOf(island);
  if (suspect.empty()) return {};
  return fmt::format(
      "; {} is too fast, too stiff or too light for any step: give it more inertia or damping, or "
      "what drives it less stiffness{}",
      suspect, engine.has_set_steps() ? ", or take shorter steps (dynamics: {step: 100us})" : "");
}

void CheckState(IslandEngine& engine, int island, std::span<const double> state, VirtualTime t,
                const WhoDiverged& who) {
  if (!AllFinite(state)) ThrowDiverged(engine, island, who(island, state), t.seconds());
}

void TakeSteps(IslandEngine& engine, std::span<IslandStep* const> steps, const WhoDiverged& who) {
  try {
    engine.TakeAll(steps);
    for (const IslandStep* step : steps) Check(engine, *step, who);
  } catch (const std::exception&) {
    TakeEachStep(engine, steps, who);
  }
}

}  // namespace tcs
