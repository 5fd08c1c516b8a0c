// Free bodies on MuJoCo: each body is a model of one link that touches nothing. Islands of equal
// bodies share a system, which is a function.
#include <algorithm>
#include <deque>
#include <map>

#include "simbody_bridge/loads.h"
#include "simbody_bridge/masses.h"
#include "simbody_bridge/mujoco/mujoco_engine.h"
#include "simbody_bridge/mujoco/mujoco_system.h"
#include "simbody_bridge/region_law.h"
#include "simbody_bridge/set_steps.h"

namespace tcs {
namespace {

RobotModel ModelOf(const BodySpec& body) {
  Inertial inertial;
  inertial.mass_kg = body.mass_kg;
  inertial.ixx_kgm2 = body.inertia_kgm2[0];
  inertial.iyy_kgm2 = body.inertia_kgm2[1];
  inertial.izz_kgm2 = body.inertia_kgm2[2];
  RobotModel model;
  model.name = body.name;
  model.links.push_back({.name = body.name, .inertial = inertial, .shapes = {}});
  model.at = {body.initial.position_m, body.initial.orientation_xyzw};
  model.linear_velocity_mps = body.initial.linear_velocity_mps;
  model.angular_velocity_radps = body.initial.angular_velocity_radps;
  return model;
}

class MujocoBodies : public SetStepEngine<BodyEngine> {
 public:
  MujocoBodies(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : SetStepEngine(world.integrator.StepOr(kMujocoStep)),
        has_region_(world.has_region),
        region_(world.region),
        loads_(world, islands) {
    for (const BodySpec& body : world.bodies) models_.push_back(ModelOf(body));
    std::map<Masses, MujocoSystem*> known;
    for (const std::vector<int>& bodies : islands) {
      MujocoSystem*& system = known[MassesOf(world, bodies)];
      if (system == nullptr) system = &AddSystem(world, bodies);
      // The system's start is that of the island that it was made for.
      islands_.push_back({system, StartOf(bodies)});
    }
  }

  bool may_be_doubled() const override { return true; }
  IslandStart StartOf(int island) override { return {At(island).start, 0}; }

  // A free joint's own numbers: the position and the quaternion w x y z; the velocity, and the
  // angular velocity along the body's axes.
  BodyState Read(int island, int place, std::span<const double> state) const override {
    const std::size_t bodies = At(island).start.size() / kNumbers;
    const auto body = static_cast<std::size_t>(place);
    const double* q = &state[7 * body];
    const double* u = &state[7 * bodies + 6 * body];
    BodyState value;
    value.position_m = {q[0], q[1], q[2]};
    value.orientation_xyzw = Normalised({q[4], q[5], q[6], q[3]});
    value.linear_velocity_mps = {u[0], u[1], u[2]};
    value.angular_velocity_radps = Rotate(value.orientation_xyzw, {u[3], u[4], u[5]});
    return value;
  }

 private:
  static constexpr std::size_t kNumbers = 7 + 6 + 6;  // of a body, with the solver's guess

  struct Island {
    MujocoSystem* system;
    std::vector<double> start;
  };
  const Island& At(int island) const { return islands_[static_cast<std::size_t>(island)]; }

  MujocoSystem& AddSystem(const WorldSpec& world, const std::vector<int>& bodies) {
    forests_.push_back(MakeForest(models_, bodies, {}));
    return systems_.emplace_back(forests_.back(), world.gravity_mps2);
  }

  std::vector<double> StartOf(const std::vector<int>& bodies) const {
    std::vector<double> positions, speeds;
    for (const int index : bodies) {
      const RobotModel& model = models_[static_cast<std::size_t>(index)];
      const auto [x, y, z, w] = Normalised(model.at.orientation_xyzw);
      const auto& p = model.at.position_m;
      const auto& v = model.linear_velocity_mps;
      const auto turning = Rotate({-x, -y, -z, w}, model.angular_velocity_radps);
      positions.insert(positions.end(), {p[0], p[1], p[2], w, x, y, z});
      speeds.insert(speeds.end(), {v[0], v[1], v[2], turning[0], turning[1], turning[2]});
    }
    positions.insert(positions.end(), speeds.begin(), speeds.end());
    positions.resize(positions.size() + speeds.size());
    return positions;
  }

  // Walls push as they do at the beginning of the step; all other loads have their mean over the
  // step.
  void Advance(const IslandStep& step, double seconds, std::vector<double>* to) override {
    const std::size_t bodies = step.wrenches.size();
    acting_.assign(2 * bodies, Wrench{});
    for (std::size_t i = 0; i < bodies; ++i) {
      const int place = static_cast<int>(i);
      Wrench& wrench = acting_[static_cast<std::size_t>(PlaceOfLink(place, WrenchFrame::kWorld))];
      const BodyState state = Read(step.island, place, step.from);
      const Load load = loads_.MeanOver(step, i, seconds, state);
      wrench.force_n = load.force_n;
      wrench.torque_nm = load.torque_nm;
      if (has_region_) AddWallForce(region_, state, &wrench.force_n);
    }
    At(step.island).system->Step(step.from, acting_, seconds, to);
  }

  const bool has_region_;
  const RegionSpec region_;
  const Loads loads_;
  std::vector<RobotModel> models_;  // of all bodies
  std::deque<Forest> forests_;
  std::deque<MujocoSystem> systems_;
  std::vector<Island> islands_;
  std::vector<Wrench> acting_;  // memory of Advance
};

}  // namespace

std::unique_ptr<BodyEngine> MakeMujocoBodies(const WorldSpec& world,
                                             const std::vector<std::vector<int>>& islands) {
  return std::make_unique<MujocoBodies>(world, islands);
}

}  // namespace tcs
