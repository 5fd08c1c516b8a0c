// ODE's world with our bodies in it, as a function: from where they are and what acts on them to
// where they are one step later. The class does not rely on what ODE itself remembers from step to
// step: every step begins by writing all of the state into ODE, so that equal states go on equally,
// however they were come by.
#pragma once

#include <ode/common.h>

#include <memory>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/load.h"

namespace tcs {

class OdeWorld {
 public:
  // `world` has passed CheckWorld, and OpenOde has been called.
  explicit OdeWorld(const WorldSpec& world);

  // `states` and `loads` have one element for each body. Orientations are of unit length, and stay
  // so.
  void Step(double seconds, const std::vector<Load>& loads, std::vector<BodyState>* states);

 private:
  struct Destroy {
    void operator()(dxWorld* world) const;
  };

  const WorldSpec spec_;
  std::unique_ptr<dxWorld, Destroy> world_;
  std::vector<dBodyID> bodies_;  // the world owns them
};

}  // namespace tcs
