// Dynamics over islands: finds those that a call is about, and lets the engines take the steps that
// they need. Free bodies and models have an engine each, and no island has both.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/island.h"
#include "simbody_bridge/model/finite.h"
#include "simbody_bridge/model_engine.h"
#include "simbody_bridge/model_loads.h"
#include "simbody_bridge/require.h"
#include "simbody_bridge/world_check.h"

namespace tcs {
namespace {

// Commands to a body that nobody reads are worked off once there are so many.
constexpr std::size_t kMostPending = 64;

struct IslandsCheckpoint : Dynamics::Checkpoint {
  const void* origin = nullptr;
  VirtualTime now;
  std::vector<Island::Saved> islands;
};

// Links, joints and rotors are counted through all models.
template <class Part>
const Part& PartAt(const std::vector<RobotModel>& models, std::vector<Part> RobotModel::*parts,
                   std::size_t index) {
  std::size_t model = 0;
  while (index >= (models[model].*parts).size()) index -= (models[model++].*parts).size();
  return (models[model].*parts)[index];
}
const Link& LinkAt(const std::vector<RobotModel>& models, std::size_t index) {
  return PartAt(models, &RobotModel::links, index);
}
const Joint& JointAt(const std::vector<RobotModel>& models, std::size_t index) {
  return PartAt(models, &RobotModel::joints, index);
}
const Rotor& RotorAt(const std::vector<RobotModel>& models, std::size_t index) {
  return PartAt(models, &RobotModel::rotors, index);
}

template <class Part>
std::optional<int> Find(const std::vector<RobotModel>& models,
                        const std::vector<std::size_t>& firsts,
                        std::vector<Part> RobotModel::*parts, std::string_view model,
                        std::string_view name) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (models[i].name != model) continue;
    const std::vector<Part>& all = models[i].*parts;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k].name == name) return static_cast<int>(firsts[i] + k);
    }
  }
  return {};
}

class Islands : public Dynamics {
 public:
  explicit Islands(const WorldSpec& world);

  int island_count() const override { return static_cast<int>(islands_.size()); }
  VirtualTime Now() const override { return now_; }
  void AdvanceTo(VirtualTime t) override;
  void Apply(int body, const Wrench& wrench, VirtualTime t) override;
  void Read(VirtualTime t, std::span<const int> bodies, std::span<BodyState> states) override;
  std::optional<int> FindLink(std::string_view model, std::string_view link) const override;
  std::optional<int> FindJoint(std::string_view model, std::string_view joint) const override;
  std::optional<int> FindRotor(std::string_view model, std::string_view rotor) const override;
  void ApplyToLink(int link, WrenchFrame frame, const Wrench& wrench, VirtualTime t) override;
  void Drive(int joint, const JointDrive& drive, VirtualTime t) override;
  void Spin(int rotor, double speed_radps, VirtualTime t) override;
  void ReadLinks(VirtualTime t, std::span<const int> links, std::span<LinkState> states) override;
  void ReadJoints(VirtualTime t, std::span<const int> joints,
                  std::span<JointState> states) override;
  std::unique_ptr<Checkpoint> Save(std::unique_ptr<Checkpoint> reuse) override;
  void Restore(const Checkpoint& checkpoint) override;
  const Work& work() const override { return work_; }

 private:
  // Of a body among its island's bodies, of a link among its links, of a joint among its joints, of
  // a rotor among all.
  struct Place {
    std::size_t island;
    int place;
  };
  void PlaceBodies();
  void PlaceModels();
  const Place& PlaceOf(const std::vector<Place>& places, int index) const;
  void Command(std::size_t island, int place, const Wrench& wrench, VirtualTime t);
  void ReachAll(VirtualTime t, const std::vector<Place>& places, std::span<const int> indices);
  void Reach(VirtualTime t);
  void TakeSteps();
  void TakeEachStep();
  void Check(std::size_t island, const IslandStep& step) const;
  bool HasModels(std::size_t island) const { return island >= members_.size(); }
  std::string WhoDiverged(std::size_t island, const IslandStep& step) const;
  // Calls `read` for each stretch of `places` that lies in one island, with the numbers there.
  template <class ReadStretch>
  void ForEachIsland(const std::vector<Place>& places, std::span<const int> indices,
                     const ReadStretch& read);

  // What the engines were made of. Islands of bodies come first, then those of models.
  const std::vector<RobotModel> models_;
  const std::vector<std::vector<int>> members_;        // bodies of each island of bodies
  const std::vector<std::vector<int>> model_members_;  // models of each island of models
  std::unique_ptr<BodyEngine> body_engine_;            // none where there is no body
  std::unique_ptr<ModelEngine> model_engine_;          // none where there is no model
  std::vector<std::string> names_;
  std::vector<Place> bodies_, links_, joints_, rotors_;
  std::vector<std::size_t> first_link_, first_joint_, first_rotor_;  // of each model
  std::vector<int> links_in_, joints_in_;                            // of each island
  std::vector<Island> islands_;
  ModelLoads model_loads_;
  Work work_;
  VirtualTime now_;
  // Memory of Reach and the reads.
  std::vector<std::size_t> moving_;  // islands that somebody asks for, each once or more
  std::vector<IslandStep*> steps_;   // of each of them
  std::vector<double> state_;
  std::vector<int> local_;
};

Islands::Islands(const WorldSpec& world)
    : models_(world.models),
      members_(IslandsOf(world)),
      model_members_(ModelIslandsOf(world)),
      bodies_(world.bodies.size()),
      model_loads_(models_, model_members_) {
  if (!members_.empty()) body_engine_ = MakeEngine(world, members_);
  if (!model_members_.empty()) model_engine_ = MakeModelEngine(world, model_members_);
  for (const BodySpec& body : world.bodies) names_.push_back(body.name);
  PlaceBodies();
  PlaceModels();
}

void Islands::PlaceBodies() {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const int bodies = static_cast<int>(members_[i].size());
    islands_.emplace_back(static_cast<int>(i), bodies, *body_engine_, work_);
    links_in_.push_back(0);
    joints_in_.push_back(0);
    for (int place = 0; place < bodies; ++place) {
      bodies_[static_cast<std::size_t>(members_[i][static_cast<std::size_t>(place)])] = {i, place};
    }
  }
}

void Islands::PlaceModels() {
  for (const RobotModel& model : models_) {
    first_link_.push_back(links_.size());
    first_joint_.push_back(joints_.size());
    first_rotor_.push_back(rotors_.size());
    links_.resize(links_.size() + model.links.size());
    joints_.resize(joints_.size() + model.joints.size());
    rotors_.resize(rotors_.size() + model.rotors.size());
  }
  for (std::size_t i = 0; i < model_members_.size(); ++i) {
    int links = 0, joints = 0, rotors = 0;
    for (const int index : model_members_[i]) {
      const auto model = static_cast<std::size_t>(index);
      for (std::size_t k = 0; k < models_[model].links.size(); ++k) {
        links_[first_link_[model] + k] = {islands_.size(), links++};
      }
      for (std::size_t k = 0; k < models_[model].joints.size(); ++k) {
        joints_[first_joint_[model] + k] = {islands_.size(), joints++};
      }
      for (std::size_t k = 0; k < models_[model].rotors.size(); ++k) {
        rotors_[first_rotor_[model] + k] = {islands_.size(), rotors++};
      }
    }
    links_in_.push_back(links);
    joints_in_.push_back(joints);
    islands_.emplace_back(static_cast<int>(i), PlaceOfRotor(links, joints, rotors), *model_engine_,
                          work_);
  }
}

const Islands::Place& Islands::PlaceOf(const std::vector<Place>& places, int index) const {
  Require(index >= 0 && index < static_cast<int>(places.size()),
          "no such body, link, joint or rotor in the dynamics");
  return places[static_cast<std::size_t>(index)];
}

void Islands::AdvanceTo(VirtualTime t) {
  Require(t >= now_ && !t.IsNever(), "the dynamics can only advance to a later, finite time");
  now_ = t;
}

void Islands::Apply(int body, const Wrench& wrench, VirtualTime t) {
  const Place place = PlaceOf(bodies_, body);
  CheckWrench(names_[static_cast<std::size_t>(body)], wrench);
  Command(place.island, place.place, wrench, t);
}

void Islands::ApplyToLink(int link, WrenchFrame frame, const Wrench& wrench, VirtualTime t) {
  const Place place = PlaceOf(links_, link);
  if (!AllFinite(wrench.force_n) || !AllFinite(wrench.torque_nm)) {
    throw DynamicsError(fmt::format("link '{}': a commanded wrench must be finite",
                                    LinkAt(models_, static_cast<std::size_t>(link)).name));
  }
  // The frame says along whose axes it is, and models' engines know of no lag.
  const Wrench acting{.force_n = wrench.force_n, .torque_nm = wrench.torque_nm};
  Require(wrench == acting, "a wrench on a link does not lag, and its frame is an argument");
  Command(place.island, PlaceOfLink(place.place, frame), acting, t);
}

void Islands::Drive(int joint, const JointDrive& drive, VirtualTime t) {
  const Place place = PlaceOf(joints_, joint);
  const Joint& driven = JointAt(models_, static_cast<std::size_t>(joint));
  Require(CoordinatesOf(driven.kind) == 1 && !driven.mimic.has_value(),
          "a joint that is driven has one coordinate of its own");
  const bool lags = driven.drive_lag > VirtualDuration{};
  const Wrench numbers = lags ? AsNumbers(drive, driven.drive_lag) : AsNumbers(drive);
  if (!AllFinite(numbers.force_n) || !AllFinite(numbers.torque_nm)) {
    throw DynamicsError(fmt::format("joint '{}': what drives it must be finite", driven.name));
  }
  Command(place.island, PlaceOfJoint(links_in_[place.island], place.place), numbers, t);
}

void Islands::Spin(int rotor, double speed_radps, VirtualTime t) {
  const Place place = PlaceOf(rotors_, rotor);
  const Rotor& spun = RotorAt(models_, static_cast<std::size_t>(rotor));
  if (!(speed_radps >= 0 && speed_radps <= spun.most_radps) || !std::isfinite(speed_radps)) {
    throw DynamicsError(fmt::format("rotor '{}': its speed must be between 0 and {} rad/s",
                                    spun.name, spun.most_radps));
  }
  Command(place.island,
          PlaceOfRotor(links_in_[place.island], joints_in_[place.island], place.place),
          AsNumbers(speed_radps, spun.time_constant), t);
}

void Islands::Command(std::size_t index, int place, const Wrench& wrench, VirtualTime t) {
  Require(t >= now_ && !t.IsNever(), "a command cannot act before the dynamics' present");
  Island& island = islands_[index];
  if (island.CommandsUntil(now_) >= kMostPending) {
    moving_.assign(1, index);
    Reach(now_);
  }
  island.Settle(now_);
  island.Apply(place, wrench, t);
}

std::optional<int> Islands::FindLink(std::string_view model, std::string_view link) const {
  return Find(models_, first_link_, &RobotModel::links, model, link);
}

std::optional<int> Islands::FindJoint(std::string_view model, std::string_view joint) const {
  return Find(models_, first_joint_, &RobotModel::joints, model, joint);
}

std::optional<int> Islands::FindRotor(std::string_view model, std::string_view rotor) const {
  return Find(models_, first_rotor_, &RobotModel::rotors, model, rotor);
}

void Islands::ReachAll(VirtualTime t, const std::vector<Place>& places,
                       std::span<const int> indices) {
  Require(t >= now_ && !t.IsNever(), "a state of the past is not known any more");
  moving_.clear();
  for (const int index : indices) moving_.push_back(PlaceOf(places, index).island);
  Reach(t);
}

void Islands::Read(VirtualTime t, std::span<const int> bodies, std::span<BodyState> states) {
  Require(bodies.size() == states.size(), "one state for each body that is read");
  ReachAll(t, bodies_, bodies);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Place& place = PlaceOf(bodies_, bodies[i]);
    islands_[place.island].StateAt(t, &state_);
    states[i] = body_engine_->Read(static_cast<int>(place.island), place.place, state_);
  }
}

template <class ReadStretch>
void Islands::ForEachIsland(const std::vector<Place>& places, std::span<const int> indices,
                            const ReadStretch& read) {
  for (std::size_t first = 0; first < indices.size(); first += local_.size()) {
    const std::size_t island = PlaceOf(places, indices[first]).island;
    local_.clear();
    for (const int index : indices.subspan(first)) {
      const Place& place = PlaceOf(places, index);
      if (place.island != island) break;
      local_.push_back(place.place);
    }
    read(island, first, local_.size());
  }
}

void Islands::ReadLinks(VirtualTime t, std::span<const int> links, std::span<LinkState> states) {
  Require(links.size() == states.size(), "one state for each link that is read");
  ReachAll(t, links_, links);
  ForEachIsland(links_, links, [&](std::size_t island, std::size_t first, std::size_t count) {
    islands_[island].StateAt(t, &state_);
    model_engine_->ReadLinks(static_cast<int>(island - members_.size()), state_, local_,
                             states.subspan(first, count));
  });
}

void Islands::ReadJoints(VirtualTime t, std::span<const int> joints, std::span<JointState> states) {
  Require(joints.size() == states.size(), "one state for each joint that is read");
  ReachAll(t, joints_, joints);
  ForEachIsland(joints_, joints, [&](std::size_t island, std::size_t first, std::size_t count) {
    islands_[island].StateAt(t, &state_);
    const int index = static_cast<int>(island - members_.size());
    const Island::Acting acting = islands_[island].ActingUntil(t);
    model_engine_->ReadJoints(index, state_,
                              model_loads_.At(index, acting.wrenches, acting.remainders, t), local_,
                              states.subspan(first, count));
  });
}

// Takes all steps that lead to `t` of those in `moving_`: the next one of each, until no one needs
// any more.
void Islands::Reach(VirtualTime t) {
  std::sort(moving_.begin(), moving_.end());
  moving_.erase(std::unique(moving_.begin(), moving_.end()), moving_.end());
  for (const std::size_t island : moving_) islands_[island].Settle(now_);
  for (;;) {
    steps_.clear();
    std::size_t left = 0;
    for (const std::size_t island : moving_) {
      IslandStep* step = islands_[island].NextStepTo(t);
      if (step == nullptr) continue;
      moving_[left++] = island;
      steps_.push_back(step);
    }
    moving_.resize(left);
    if (steps_.empty()) return;
    TakeSteps();
    for (const std::size_t island : moving_) {
      islands_[island].Took();
      islands_[island].Settle(now_);
    }
  }
}

// `moving_` rises, and so the steps of bodies come first.
void Islands::TakeSteps() {
  const auto models = static_cast<std::size_t>(
      std::lower_bound(moving_.begin(), moving_.end(), members_.size()) - moving_.begin());
  const std::span<IslandStep* const> all = steps_;
  try {
    if (models > 0) body_engine_->TakeAll(all.first(models));
    if (models < all.size()) model_engine_->TakeAll(all.subspan(models));
    for (std::size_t i = 0; i < all.size(); ++i) Check(moving_[i], *all[i]);
  } catch (const std::exception&) {
    TakeEachStep();
  }
}

// One of the steps cannot be taken: to say which, and whose it is.
void Islands::TakeEachStep() {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const double from_s = islands_[moving_[i]].StepStart().seconds();
    try {
      if (HasModels(moving_[i])) {
        model_engine_->Take(*steps_[i]);
      } else {
        body_engine_->Take(*steps_[i]);
      }
    } catch (const DynamicsError&) {
      throw;
    } catch (const std::exception& e) {
      throw DynamicsError(
          fmt::format("the integration from {:.12g} s on failed: {}", from_s, e.what()));
    }
    Check(moving_[i], *steps_[i]);
  }
}

// With steps of a set length engines take whatever comes out of one, and stumble over it only in
// the next.
void Islands::Check(std::size_t island, const IslandStep& step) const {
  const double from_s = islands_[island].StepStart().seconds();
  if (AllFinite(step.to) && AllFinite(step.to_rate)) {
    if (LengthOf(step) > VirtualDuration{}) return;
    throw DynamicsError(fmt::format(
        "the integration from {:.12g} s on failed: the integrator makes no progress", from_s));
  }
  throw DynamicsError(fmt::format("{}: its motion has diverged by {:.12g} s",
                                  WhoDiverged(island, step), from_s + step.length_s));
}

std::string Islands::WhoDiverged(std::size_t island, const IslandStep& step) const {
  if (HasModels(island)) {
    const std::vector<int>& models = model_members_[island - members_.size()];
    std::string text = "model '" + models_[static_cast<std::size_t>(models[0])].name + "'";
    if (models.size() > 1)
      text += fmt::format(" or one of {} that it can touch", models.size() - 1);
    return text;
  }
  std::size_t place = 0;
  while (place + 1 < members_[island].size() &&
         AllFinite(body_engine_->Read(step.island, static_cast<int>(place), step.to))) {
    ++place;
  }
  return fmt::format("body '{}'", names_[static_cast<std::size_t>(members_[island][place])]);
}

std::unique_ptr<Dynamics::Checkpoint> Islands::Save(std::unique_ptr<Checkpoint> reuse) {
  if (reuse == nullptr) reuse = std::make_unique<IslandsCheckpoint>();
  auto* checkpoint = dynamic_cast<IslandsCheckpoint*>(reuse.get());
  Require(checkpoint != nullptr && (checkpoint->origin == nullptr || checkpoint->origin == this),
          "a checkpoint belongs to the dynamics that saved it");
  checkpoint->origin = this;
  checkpoint->now = now_;
  checkpoint->islands.resize(islands_.size());
  for (std::size_t i = 0; i < islands_.size(); ++i) islands_[i].Save(&checkpoint->islands[i]);
  return reuse;
}

void Islands::Restore(const Checkpoint& checkpoint) {
  const auto* saved = dynamic_cast<const IslandsCheckpoint*>(&checkpoint);
  Require(saved != nullptr && saved->origin == this,
          "a checkpoint belongs to the dynamics that saved it");
  now_ = saved->now;
  for (std::size_t i = 0; i < islands_.size(); ++i) islands_[i].Restore(saved->islands[i]);
}

}  // namespace

std::unique_ptr<Dynamics> MakeDynamics(const WorldSpec& world) {
  CheckWorld(world);
  return std::make_unique<Islands>(world);
}

}  // namespace tcs
