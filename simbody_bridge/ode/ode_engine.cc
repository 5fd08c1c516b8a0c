#include "simbody_bridge/ode/ode_engine.h"

#include <array>
#include <cstring>
#include <deque>

#include "simbody_bridge/loads.h"
#include "simbody_bridge/model/vectors.h"
#include "simbody_bridge/ode/ode_library.h"
#include "simbody_bridge/ode/ode_world.h"
#include "simbody_bridge/set_steps.h"

namespace tcs {
namespace {

// The island's state: the bodies' states, one after the other.
constexpr std::size_t kNumbers = sizeof(BodyState) / sizeof(double);
static_assert(kNumbers == 13, "BodyState has padding or a new member");

class OdeEngine : public SetStepEngine<BodyEngine> {
 public:
  OdeEngine(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : SetStepEngine(world.integrator.StepOr(kOdeStep)), loads_(world, islands) {
    for (const std::vector<int>& members : islands) {
      WorldSpec part = world;
      part.bodies.clear();
      for (const int body : members) {
        part.bodies.push_back(world.bodies[static_cast<std::size_t>(body)]);
      }
      islands_.emplace_back(part);
      starts_.emplace_back();
      for (const BodySpec& body : part.bodies) {
        starts_.back().push_back(body.initial);
        Normalise(starts_.back().back().orientation_xyzw);
      }
    }
  }

  IslandStart StartOf(int island) override {
    IslandStart start;
    ToState(starts_[static_cast<std::size_t>(island)], &start.state);
    return start;
  }

  BodyState Read(int /*island*/, int place, std::span<const double> state) const override {
    BodyState body;
    const double* numbers = &state[kNumbers * static_cast<std::size_t>(place)];
    std::memcpy(static_cast<void*>(&body), numbers, sizeof body);
    return body;
  }

 private:
  static void ToState(const std::vector<BodyState>& bodies, std::vector<double>* state) {
    state->resize(kNumbers * bodies.size());
    if (!bodies.empty())
      std::memcpy(state->data(), bodies.data(), bodies.size() * sizeof(BodyState));
  }

  void Advance(const IslandStep& step, double seconds, std::vector<double>* state) override {
    bodies_.resize(step.wrenches.size());
    acting_.resize(step.wrenches.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      bodies_[i] = Read(step.island, static_cast<int>(i), step.from);
      acting_[i] = loads_.MeanOver(step, i, seconds, bodies_[i]);
    }
    islands_[static_cast<std::size_t>(step.island)].Step(seconds, acting_, &bodies_);
    ToState(bodies_, state);
  }

  const Loads loads_;
  std::deque<OdeWorld> islands_;
  std::vector<std::vector<BodyState>> starts_;
  std::vector<BodyState> bodies_;  // memory of Advance
  std::vector<Load> acting_;
};

}  // namespace

std::unique_ptr<BodyEngine> MakeOdeEngine(const WorldSpec& world,
                                          const std::vector<std::vector<int>>& islands) {
  OpenOde();
  return std::make_unique<OdeEngine>(world, islands);
}

}  // namespace tcs
