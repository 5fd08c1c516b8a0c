// A robot as MuJoCo's own loader of URDF files reads it, which tcs does not use otherwise. The
// loader fixes a root to the world, and knows no mimics. What is not smooth is switched off:
// contacts, stops, Coulomb's friction.
#pragma once

#include <array>
#include <memory>
#include <string>

namespace tcs {

class MujocoRobot {
 public:
  // `urdf` is the text of a file, which names no meshes. Runge-Kutta 4, by steps of `step_s`.
  // Throws std::runtime_error where MuJoCo refuses it.
  MujocoRobot(const std::string& urdf, const std::array<double, 3>& gravity_mps2, double step_s);
  ~MujocoRobot();
  MujocoRobot(const MujocoRobot&) = delete;
  MujocoRobot& operator=(const MujocoRobot&) = delete;

  // Of joints that have one coordinate.
  void Set(const std::string& joint, double position, double velocity);
  double PositionOf(const std::string& joint) const;
  void Advance(int steps);

 private:
  class Loaded;
  std::unique_ptr<Loaded> loaded_;
};

}  // namespace tcs
