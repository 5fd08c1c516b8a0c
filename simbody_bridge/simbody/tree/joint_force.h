// The forces along the joints, as a Simbody force element: drives, damping, and the stops at the
// ends of the joints' ranges. Friction is no function of the state: the steps find it.
#pragma once

#include <span>
#include <vector>

#include "simbody_bridge/simbody/tree/forest_force.h"

namespace tcs {

class JointForce : public ForestForce {
 public:
  JointForce(const Forest& forest, std::vector<SimTK::MobilizedBody> bodies,
             const std::span<const Wrench>& acting);

  // Finds how hard the stops have to be for the bodies that hang on the joints at the start.
  void Measure(const SimTK::SimbodyMatterSubsystem& matter, const SimTK::State& start);

  // How the forces fall as each speed grows, and as each coordinate that is a joint's only one
  // does. At least 0. Drives that are at their limits give what they give.
  void Slopes(const SimTK::State& state, std::vector<double>* by_speed,
              std::vector<double>* by_coordinate) const;

  // The drive of a joint, and its limit.
  struct LimitedDrive {
    std::size_t speed;  // the joint's, among all
    double position, velocity;
    JointDrive drive;
    double limit;
  };
  // The drives with a spring or a damper, in the state where the forces were evaluated last.
  void FindDrives(const SimTK::State& state, std::vector<LimitedDrive>* drives) const;

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>& particle_forces,
                 SimTK::Vector& mobility_forces) const override;

 private:
  std::vector<double> inertia_;  // inertia that each joint moves: kg m^2 or kg
};

// How long a joint takes to a stop at its present speed, in s; at least the time that it takes to
// notice a joint in a stop.
double TimeToStop(const Joint& joint, double position, double velocity);

}  // namespace tcs
