#include "simbody_bridge/simbody/lanes_engine.h"

#include <utility>

#include "simbody_bridge/simbody/model.h"
#include "simbody_bridge/simbody/rates.h"
#include "simbody_bridge/simbody/runge_kutta3.h"
#include "simbody_bridge/simbody/steps.h"

namespace tcs {
namespace {

constexpr double kFirstTryS = 0.01;  // Simbody's own integrators begin so, too

class LanesEngine : public BodyEngine {
 public:
  LanesEngine(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : method_(world.integrator.accuracy), rates_(world, islands) {
    for (const std::vector<int>& bodies : islands) AddIsland(world, bodies);
  }

  IslandStart StartOf(int island) override { return {At(island).start, kFirstTryS}; }
  VirtualDuration LongestStep(int island) const override { return At(island).longest_step; }
  bool has_set_steps() const override { return false; }
  bool may_be_doubled() const override { return rates_.has_one_kind(); }

  void Take(IslandStep& step) override {
    IslandStep* one = &step;
    method_.Take(rates_, {&one, 1});
  }
  void TakeAll(std::span<IslandStep* const> steps) override { method_.Take(rates_, steps); }
  void Within(const IslandStep& step, VirtualDuration after, std::vector<double>* state) override {
    Interpolate(step, after.seconds(), state);
  }
  BodyState Read(int island, int place, std::span<const double> state) const override {
    return ReadBody(state, At(island).body_count, place);
  }

 private:
  struct Island {
    int body_count;
    std::vector<double> start;
    VirtualDuration longest_step;
  };
  const Island& At(int island) const { return islands_[static_cast<std::size_t>(island)]; }
  void AddIsland(const WorldSpec& world, const std::vector<int>& bodies);

  RungeKutta3 method_;
  SimbodyRates rates_;
  std::vector<Island> islands_;
};

void LanesEngine::AddIsland(const WorldSpec& world, const std::vector<int>& bodies) {
  Island island{static_cast<int>(bodies.size()), {}, LongestStepBeside(world, bodies)};
  island.start.resize(kFreeBodyNumbers * bodies.size());
  for (int place = 0; place < island.body_count; ++place) {
    const int body = bodies[static_cast<std::size_t>(place)];
    WriteBody(world.bodies[static_cast<std::size_t>(body)].initial, island.body_count, place,
              island.start);
  }
  NormaliseQuaternions(island.start, island.body_count);
  islands_.push_back(std::move(island));
}

}  // namespace

std::unique_ptr<BodyEngine> MakeLanesEngine(const WorldSpec& world,
                                            const std::vector<std::vector<int>>& islands) {
  return std::make_unique<LanesEngine>(world, islands);
}

}  // namespace tcs
