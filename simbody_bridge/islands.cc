// Dynamics over islands: islands of free bodies and islands of models, which have an engine each.
#include <utility>

#include "simbody_bridge/body_islands.h"
#include "simbody_bridge/contact_forces.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/model_islands.h"
#include "simbody_bridge/require.h"
#include "simbody_bridge/team.h"
#include "simbody_bridge/world_check.h"

namespace tcs {
namespace {

struct IslandsCheckpoint : Dynamics::Checkpoint {
  const void* origin = nullptr;
  VirtualTime now;
  BodyIslands::Saved bodies;
  ModelIslands::Saved models;
};

class Islands : public Dynamics {
 public:
  explicit Islands(const WorldSpec& world)
      : world_(world), bodies_(world, work_), models_(world, work_) {}

  void UseProcessors(std::span<const int> cpus) override {
    team_.Set(cpus);
    bodies_.UseTeam(world_, team_);
    models_.UseTeam(team_);
  }

  void InterruptBy(const std::function<bool()>& asked) override {
    bodies_.InterruptBy(asked);
    models_.InterruptBy(asked);
  }

  int island_count() const override { return bodies_.count() + models_.count(); }
  VirtualTime Now() const override { return now_; }
  void AdvanceTo(VirtualTime t) override {
    Require(t >= now_ && !t.IsNever(), "the dynamics can only advance to a later, finite time");
    now_ = t;
  }

  void Apply(int body, const Wrench& wrench, VirtualTime t) override {
    RequirePresent(t);
    bodies_.Apply(body, wrench, t, now_);
  }
  void Read(VirtualTime t, std::span<const int> bodies, std::span<BodyState> states) override {
    Require(bodies.size() == states.size(), "one state for each body that is read");
    RequireKnown(t);
    bodies_.Read(t, now_, bodies, states);
  }

  std::optional<int> FindLink(std::string_view model, std::string_view link) const override {
    return models_.parts().FindLink(model, link);
  }
  std::optional<int> FindJoint(std::string_view model, std::string_view joint) const override {
    return models_.parts().FindJoint(model, joint);
  }
  std::optional<int> FindRotor(std::string_view model, std::string_view rotor) const override {
    return models_.parts().FindRotor(model, rotor);
  }
  void ApplyToLink(int link, WrenchFrame frame, const Wrench& wrench, VirtualTime t) override {
    RequirePresent(t);
    models_.ApplyToLink(link, frame, wrench, t, now_);
  }
  void Drive(int joint, const JointDrive& drive, VirtualTime t) override {
    RequirePresent(t);
    models_.Drive(joint, drive, t, now_);
  }
  void Spin(int rotor, double speed_radps, VirtualTime t) override {
    RequirePresent(t);
    models_.Spin(rotor, speed_radps, t, now_);
  }
  void ReadLinks(VirtualTime t, std::span<const int> links, std::span<LinkState> states) override {
    Require(links.size() == states.size(), "one state for each link that is read");
    RequireKnown(t);
    models_.ReadLinks(t, now_, links, states);
  }
  void ReadJoints(VirtualTime t, std::span<const int> joints,
                  std::span<JointState> states) override {
    Require(joints.size() == states.size(), "one state for each joint that is read");
    RequireKnown(t);
    models_.ReadJoints(t, now_, joints, states);
  }

  void ReadContacts(VirtualTime t, std::vector<ContactForce>* contacts) override {
    RequireKnown(t);
    contacts->clear();
    models_.ReadContacts(t, now_, contacts);
    SortForces(contacts);
  }

  std::unique_ptr<Checkpoint> Save(std::unique_ptr<Checkpoint> reuse) override;
  void Restore(const Checkpoint& checkpoint) override;
  const Work& work() const override { return work_; }

 private:
  void RequireKnown(VirtualTime t) const {
    Require(t >= now_ && !t.IsNever(), "a state of the past is not known any more");
  }
  void RequirePresent(VirtualTime t) const {
    Require(t >= now_ && !t.IsNever(), "a command cannot act before the dynamics' present");
  }

  const WorldSpec world_;
  Work work_;
  VirtualTime now_;
  Team team_{work_.helped};
  BodyIslands bodies_;
  ModelIslands models_;
};

std::unique_ptr<Dynamics::Checkpoint> Islands::Save(std::unique_ptr<Checkpoint> reuse) {
  if (reuse == nullptr) reuse = std::make_unique<IslandsCheckpoint>();
  auto* checkpoint = dynamic_cast<IslandsCheckpoint*>(reuse.get());
  Require(checkpoint != nullptr && (checkpoint->origin == nullptr || checkpoint->origin == this),
          "a checkpoint belongs to the dynamics that saved it");
  checkpoint->origin = this;
  checkpoint->now = now_;
  bodies_.Save(&checkpoint->bodies);
  models_.Save(now_, &checkpoint->models);
  return reuse;
}

void Islands::Restore(const Checkpoint& checkpoint) {
  const auto* saved = dynamic_cast<const IslandsCheckpoint*>(&checkpoint);
  Require(saved != nullptr && saved->origin == this,
          "a checkpoint belongs to the dynamics that saved it");
  now_ = saved->now;
  bodies_.Restore(saved->bodies);
  models_.Restore(saved->models);
}

}  // namespace

std::unique_ptr<Dynamics> MakeDynamics(const WorldSpec& world) {
  CheckWorld(world);
  return std::make_unique<Islands>(world);
}

}  // namespace tcs
