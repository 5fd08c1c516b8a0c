// A robot as DART moves it, which tcs does not use otherwise: read from the URDF file by DART's own
// loader, and by its forward dynamics (DART's own steps are of first order). What DART makes of
// stops, friction and contact is left out: it moves freely.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "simbody_bridge/model/robot_model.h"

namespace tcs {

class DartRobot {
 public:
  // The file `urdf`, whose packages are the folders of their names in `packages`. `start` says by
  // name where its joints start, and how its base is.
  DartRobot(const std::string& urdf, const std::string& packages, const RobotModel& start,
            const std::array<double, 3>& gravity_mps2);
  ~DartRobot();
  DartRobot(const DartRobot&) = delete;
  DartRobot& operator=(const DartRobot&) = delete;

  // From now on; N m or N.
  void SetEffort(std::string_view joint, double effort);
  // By so many Runge-Kutta 4 steps.
  void Advance(double seconds, int steps);

  double PositionOf(std::string_view joint) const;
  Pose PoseOf(std::string_view link) const;  // in the world

 private:
  class Motion;
  std::unique_ptr<Motion> motion_;
};

}  // namespace tcs
