#include "simbody_bridge/simbody/integrator_engine.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "simbody_bridge/masses.h"
#include "simbody_bridge/one_line.h"
#include "simbody_bridge/simbody/make_integrator.h"
#include "simbody_bridge/simbody/model.h"
#include "simbody_bridge/simbody/simbody.h"
#include "simbody_bridge/simbody/steps.h"

namespace tcs {
namespace {

void Copy(const SimTK::Vector& from, std::vector<double>* to) {
  to->assign(from.getContiguousScalarData(), from.getContiguousScalarData() + from.size());
}

class IntegratorEngine : public BodyEngine {
 public:
  IntegratorEngine(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : fixed_step_(world.integrator.fixed_step), loads_(world, islands) {
    for (const std::vector<int>& bodies : islands) AddIsland(world, bodies);
  }

  IslandStart StartOf(int island) override {
    const SimTK::Integrator& integrator = *At(island).integrator;
    IslandStart start;
    Copy(integrator.getAdvancedState().getY(), &start.state);
    start.try_s = integrator.getPredictedNextStepSize();
    return start;
  }
  VirtualDuration LongestStep(int island) const override { return At(island).longest_step; }
  bool has_set_steps() const override { return fixed_step_ > VirtualDuration{}; }

  void Take(IslandStep& step) override;
  void Within(const IslandStep& step, VirtualDuration after, std::vector<double>* state) override;
  BodyState Read(int island, int place, std::span<const double> state) const override {
    return ReadBody(state, At(island).model->body_count(), place);
  }

 private:
  struct Island {
    const SimbodyModel* model;
    std::shared_ptr<SimTK::Integrator> integrator;
    VirtualDuration longest_step;
    bool has_failed = false;  // in its last step, so that it has to be set up anew
  };
  Island& At(int island) { return islands_[static_cast<std::size_t>(island)]; }
  const Island& At(int island) const { return islands_[static_cast<std::size_t>(island)]; }
  void AddIsland(const WorldSpec& world, const std::vector<int>& bodies);
  const SimbodyModel* ModelOf(const WorldSpec& world, const std::vector<int>& bodies);
  void SetUp(Island& island, const IslandStep& step) const;
  void SetState(const Island& island, const IslandStep& step, SimTK::State& state) const;
  void StepOnce(SimTK::Integrator& integrator, double limit_s) const;

  const VirtualDuration fixed_step_;
  const Loads loads_;
  // Islands of equal bodies share a model.
  struct Model {
    Masses masses;
    std::unique_ptr<SimbodyModel> model;
  };
  std::vector<Model> models_;
  std::vector<Island> islands_;
  IslandStep shortened_;  // memory of Within
};

void IntegratorEngine::AddIsland(const WorldSpec& world, const std::vector<int>& bodies) {
  const SimbodyModel* model = ModelOf(world, bodies);
  SimTK::State state = model->blank_state();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    model->SetBody(state, static_cast<int>(i),
                   world.bodies[static_cast<std::size_t>(bodies[i])].initial);
  }
  auto integrator = MakeIntegrator(world.integrator, model->system());
  integrator->initialize(state);
  islands_.push_back({model, std::move(integrator),
                      has_set_steps() ? fixed_step_ : LongestStepBeside(world, bodies)});
}

const SimbodyModel* IntegratorEngine::ModelOf(const WorldSpec& world,
                                              const std::vector<int>& bodies) {
  Model made{MassesOf(world, bodies), nullptr};
  const auto known = std::find_if(models_.begin(), models_.end(),
                                  [&](const Model& model) { return model.masses == made.masses; });
  if (known != models_.end()) return known->model.get();
  made.model = std::make_unique<SimbodyModel>(world, bodies);
  models_.push_back(std::move(made));
  return models_.back().model.get();
}

void IntegratorEngine::SetState(const Island& island, const IslandStep& step,
                                SimTK::State& state) const {
  // Each step begins at zero, so that its length does not depend on how late in a run it is.
  state.updTime() = 0;
  std::copy(step.from.begin(), step.from.end(), &state.updY()[0]);
  for (std::size_t i = 0; i < step.wrenches.size(); ++i) {
    const bool is_constant = loads_.IsConstant(step, i);
    island.model->SetLoad(state, static_cast<int>(i),
                          is_constant ? LoadOf(step.wrenches[i]) : Load{});
  }
  island.model->SetStep(loads_, step);
}

// An integrator remembers which length it tries next, and can be told another one only by setting
// it up anew. The setup costs more than a step, and happens where a step has failed or more than
// one has been taken back.
void IntegratorEngine::SetUp(Island& island, const IslandStep& step) const {
  SimTK::State state = island.model->blank_state();
  SetState(island, step, state);
  if (!has_set_steps()) island.integrator->setInitialStepSize(step.try_s);
  island.integrator->initialize(state);
  island.has_failed = false;
}

void IntegratorEngine::Take(IslandStep& step) {
  Island& island = At(step.island);
  SimTK::Integrator& integrator = *island.integrator;
  const SimTK::System& system = island.model->system();
  try {
    if (island.has_failed || integrator.getPredictedNextStepSize() != step.try_s) {
      SetUp(island, step);
    }
    island.has_failed = true;
    // Setting up normalises quaternions; the state is the step's all the same.
    SetState(island, step, integrator.updAdvancedState());
    integrator.reinitialize(SimTK::Stage::Time, false);
    const SimTK::State& state = integrator.getAdvancedState();
    if (!has_set_steps()) {
      system.realize(state, SimTK::Stage::Acceleration);
      Copy(state.getYDot(), &step.from_rate);
    }
    StepOnce(integrator, step.limit.seconds());
    Copy(state.getY(), &step.to);
    if (!has_set_steps()) {
      system.realize(state, SimTK::Stage::Acceleration);
      Copy(state.getYDot(), &step.to_rate);
    }
    step.length_s = state.getTime();
    step.next_try_s = integrator.getPredictedNextStepSize();
    island.has_failed = false;
  } catch (const std::exception& e) {
    throw std::runtime_error(OnOneLine(e.what()));
  }
}

// stepTo's second argument is the limit that Simbody does not pass; stepTo returns after each step.
void IntegratorEngine::StepOnce(SimTK::Integrator& integrator, double limit_s) const {
  while (integrator.getAdvancedTime() <= 0) {
    const auto status = integrator.stepTo(limit_s, limit_s);
    if (integrator.getAdvancedTime() <= 0 &&
        status != SimTK::Integrator::StartOfContinuousInterval) {
      throw std::runtime_error("the integrator makes no progress");
    }
  }
}

void IntegratorEngine::Within(const IslandStep& step, VirtualDuration after,
                              std::vector<double>* state) {
  if (has_set_steps()) {
    TakeShortened(*this, step, after, &shortened_, state);
    return;
  }
  Interpolate(step, after.seconds(), state);
}

}  // namespace

std::unique_ptr<BodyEngine> MakeIntegratorEngine(const WorldSpec& world,
                                                 const std::vector<std::vector<int>>& islands) {
  return std::make_unique<IntegratorEngine>(world, islands);
}

}  // namespace tcs
