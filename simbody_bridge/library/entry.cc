#include "simbody_bridge/library/entry.h"

extern "C" tcs::Dynamics* tcs_make_dynamics(const tcs::WorldSpec& world) {
  return tcs::MakeDynamics(world).release();
}
