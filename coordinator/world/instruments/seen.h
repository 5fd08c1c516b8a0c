// The view of a sensor whose sample takes time. The world is read at some instants; in between, its
// links are where their velocities say.
#pragma once

#include <vector>

#include "coordinator/world/instruments/instrument.h"
#include "simbody_bridge/rays/scene.h"

namespace tcs {

class Seen {
 public:
  Seen(const Mount& mount, const WorldSpec& world);

  // The links that Begin and GoOn read.
  std::span<const int> links() const { return links_; }
  // Reads the world as it is now; states that were read before are forgotten.
  void Begin(const Eyes& eyes);
  // Reads the world again, `after` the last look.
  void GoOn(VirtualDuration after, const Eyes& eyes);
  // Goes to the share `part` (0 to 1) of the time between the last two looks.
  void GoTo(double part);

  // How far a ray goes that leaves the mount in `direction` of the mount's frame.
  double Cast(const std::array<double, 3>& direction) const;

 private:
  void Read(const Eyes& eyes);
  static bool IsStill(const LinkState& from, const LinkState& to);

  Mount mount_;
  Scene scene_;
  std::vector<int> links_;  // the scene's, then the mount's
  std::vector<LinkState> from_, to_;
  std::vector<Pose> poses_;
  double seconds_ = 0;
  bool all_is_still_ = false;
  Pose eye_;
};

}  // namespace tcs
