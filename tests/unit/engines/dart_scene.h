// A scene of contact as DART moves it, by its own steps of 1 ms and its own collision detector,
// which knows boxes and balls: cylinders touch nothing there.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "simbody_bridge/dynamics.h"

namespace tcs {

class DartScene {
 public:
  // The models and fixtures of `world`, each of which is one box, ball or plane.
  explicit DartScene(const WorldSpec& world);
  ~DartScene();
  DartScene(const DartScene&) = delete;
  DartScene& operator=(const DartScene&) = delete;

  // One more model: that of the file `urdf`, read by DART, whose shapes have that friction. `start`
  // says where it and its joints start, where each of them is held by a servo.
  void AddRobot(const std::string& urdf, const RobotModel& start, double friction, double stiffness,
                double damping);
  void Advance(double seconds);

  // Of a model's first link.
  LinkState StateOf(std::string_view model) const;
  // Along z on that model, of all that touches it.
  double LiftOn(std::string_view model) const;

 private:
  class World;
  std::unique_ptr<World> world_;
};

}  // namespace tcs
