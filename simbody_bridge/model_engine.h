// The work of an engine for islands of models, beside taking their steps.
//
// Links and joints are counted through the models of an island, in the order in which MakeEngine
// was given them. The places of such an island: for each link a wrench along the world's axes and
// one along the link's, both at the link's origin; then for each joint its drive; then for each
// rotor its speed. model_loads.h says which of these lag, and how rotors act on their links.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "simbody_bridge/island_engine.h"

namespace tcs {

constexpr int PlaceOfLink(int link, WrenchFrame frame) {
  return 2 * link + (frame == WrenchFrame::kLink ? 1 : 0);
}
constexpr int PlaceOfJoint(int links, int joint) { return 2 * links + joint; }
constexpr int PlaceOfRotor(int links, int joints, int rotor) { return 2 * links + joints + rotor; }

// A drive as an island keeps it: there the numbers mean nothing.
inline Wrench AsNumbers(const JointDrive& drive) {
  return {.force_n = {drive.effort, drive.stiffness, drive.position},
          .torque_nm = {drive.damping, drive.velocity, 0}};
}
inline JointDrive AsDrive(const Wrench& numbers) {
  return {.effort = numbers.force_n[0],
          .stiffness = numbers.force_n[1],
          .position = numbers.force_n[2],
          .damping = numbers.torque_nm[0],
          .velocity = numbers.torque_nm[1]};
}

// The wrench on a link and the drive of a joint, among what acts on an island that has so many
// links.
inline const Wrench& WrenchOnLink(std::span<const Wrench> acting, std::size_t link,
                                  WrenchFrame frame) {
  return acting[static_cast<std::size_t>(PlaceOfLink(static_cast<int>(link), frame))];
}
inline JointDrive DriveOfJoint(std::span<const Wrench> acting, std::size_t links,
                               std::size_t joint) {
  return AsDrive(acting[static_cast<std::size_t>(
      PlaceOfJoint(static_cast<int>(links), static_cast<int>(joint)))]);
}

// A drive that lags. Its effort is linear in these numbers, so that the effort fades as they do.
inline Wrench AsNumbers(const JointDrive& drive, VirtualDuration lag) {
  Wrench numbers = AsNumbers(
      {.effort = drive.effort + drive.stiffness * drive.position + drive.damping * drive.velocity,
       .stiffness = drive.stiffness,
       .damping = drive.damping});
  numbers.lag = lag;
  return numbers;
}

// A rotor's speed as an island keeps it.
inline Wrench AsNumbers(double speed_radps, VirtualDuration lag) {
  return {.force_n = {speed_radps, 0, 0}, .lag = lag};
}

// The effort of a drive at a position and a velocity, within the joint's limit.
double EffortOf(const JointDrive& drive, double limit, double position, double velocity);

// Where a model is in the states of an island: the island's models are counted in their order
// there.
struct ModelPlace {
  int island = 0, member = 0;
};

class ModelEngine : public IslandEngine {
 public:
  // Adds one more island, of these models, to those that the engine was made with, and returns its
  // index. A model may be in many islands, each of which is one way to group it. The models touch
  // the static shapes of the models `bases`, too, as if these were the world's. Throws what the
  // engine throws if it refuses the island.
  virtual int AddIsland(const std::vector<int>& models, const std::vector<int>& bases) = 0;
  // Copies the model's part of the state of one island into the state of another one.
  virtual void CopyModel(const ModelPlace& from, std::span<const double> state,
                         const ModelPlace& to, std::span<double> into) const = 0;

  // The states of links and joints in a state of their island, at an instant at which `acting`
  // acts. Joints have one coordinate, or they are fixed.
  virtual void ReadLinks(int island, std::span<const double> state, std::span<const int> links,
                         std::span<LinkState> read) = 0;
  virtual void ReadJoints(int island, std::span<const double> state, const Acting& acting,
                          std::span<const int> joints, std::span<JointState> read) = 0;

  // Appends the contacts that push in a step that was taken, as Dynamics has them, in an order that
  // is a function of the step: the contacts that lead to the state `after` the step's beginning, up
  // to its end.
  virtual void ReadContacts(const IslandStep& step, VirtualDuration after,
                            std::vector<ContactForce>* contacts) = 0;
};

// The models of each island at least: the groups of world.models_together, and each other model
// alone. Throws DynamicsError where a model is named twice, or is none.
std::vector<std::vector<int>> ModelUnitsOf(const WorldSpec& world);
// Whether a model can run into other models.
bool CanMeet(const RobotModel& model);

// The engine that world.integrator names. `world` has passed CheckWorld. Throws DynamicsError if
// the engine has no joints, or refuses the models all the same.
std::unique_ptr<ModelEngine> MakeModelEngine(const WorldSpec& world,
                                             const std::vector<std::vector<int>>& islands);

}  // namespace tcs
