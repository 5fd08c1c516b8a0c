#include "simbody_bridge/simbody/lanes_engine.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "simbody_bridge/simbody/lanes.h"
#include "simbody_bridge/simbody/model.h"
#include "simbody_bridge/simbody/runge_kutta3.h"
#include "simbody_bridge/simbody/steps.h"

namespace tcs {
namespace {

constexpr double kFirstTryS = 0.01;  // Simbody's own integrators begin so, too

class LanesEngine : public IslandEngine {
 public:
  LanesEngine(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : method_(world.integrator.accuracy) {
    for (const std::vector<int>& bodies : islands) AddIsland(world, bodies);
  }

  IslandStart StartOf(int island) override { return {At(island).start, kFirstTryS}; }
  VirtualDuration LongestStep(int island) const override { return At(island).longest_step; }
  bool has_set_steps() const override { return false; }

  void Take(IslandStep& step) override {
    IslandStep* one = &step;
    method_.Take(kinds_[At(step.island).kind].lanes, {&one, 1});
  }
  void TakeAll(std::span<IslandStep* const> steps) override;
  void Within(const IslandStep& step, VirtualDuration after, std::vector<double>* state) override {
    Interpolate(step, after.seconds(), state);
  }
  BodyState Read(int island, int place, std::span<const double> state) const override {
    return ReadBody(state, At(island).body_count, place);
  }

 private:
  struct Island {
    std::size_t kind;
    int body_count;
    std::vector<double> start;
    VirtualDuration longest_step;
  };
  // Islands of equal bodies.
  struct Kind {
    Masses masses;
    SimbodyLanes lanes;
    std::vector<IslandStep*> steps;  // memory of TakeAll
  };
  const Island& At(int island) const { return islands_[static_cast<std::size_t>(island)]; }
  void AddIsland(const WorldSpec& world, const std::vector<int>& bodies);
  std::size_t KindOf(const WorldSpec& world, const std::vector<int>& bodies);

  RungeKutta3 method_;
  std::vector<Island> islands_;
  std::vector<Kind> kinds_;
};

void LanesEngine::AddIsland(const WorldSpec& world, const std::vector<int>& bodies) {
  Island island{
      KindOf(world, bodies), static_cast<int>(bodies.size()), {}, LongestStepBeside(world, bodies)};
  std::vector<BodyState> states;
  for (const int body : bodies) {
    states.push_back(world.bodies[static_cast<std::size_t>(body)].initial);
  }
  island.start.resize(kFreeBodyNumbers * bodies.size());
  for (int place = 0; place < island.body_count; ++place) {
    WriteBody(states[static_cast<std::size_t>(place)], island.body_count, place, island.start);
  }
  NormaliseQuaternions(island.start, island.body_count);
  islands_.push_back(std::move(island));
}

std::size_t LanesEngine::KindOf(const WorldSpec& world, const std::vector<int>& bodies) {
  const Masses masses = MassesOf(world, bodies);
  const auto known = std::find_if(kinds_.begin(), kinds_.end(),
                                  [&](const Kind& kind) { return kind.masses == masses; });
  if (known != kinds_.end()) return static_cast<std::size_t>(known - kinds_.begin());
  kinds_.push_back({masses, SimbodyLanes(world, bodies), {}});
  return kinds_.size() - 1;
}

void LanesEngine::TakeAll(std::span<IslandStep* const> steps) {
  for (Kind& kind : kinds_) kind.steps.clear();
  for (IslandStep* step : steps) kinds_[At(step->island).kind].steps.push_back(step);
  for (Kind& kind : kinds_) {
    if (!kind.steps.empty()) method_.Take(kind.lanes, kind.steps);
  }
}

}  // namespace

std::unique_ptr<IslandEngine> MakeLanesEngine(const WorldSpec& world,
                                              const std::vector<std::vector<int>>& islands) {
  return std::make_unique<LanesEngine>(world, islands);
}

}  // namespace tcs
