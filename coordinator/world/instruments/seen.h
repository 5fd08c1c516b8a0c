// What a sensor sees that takes its time: the world is read at some instants, and is in between
// where its links' velocities say.
#pragma once

#include <vector>

#include "coordinator/world/instruments/instrument.h"
#include "simbody_bridge/rays/scene.h"

namespace tcs {

class Seen {
 public:
  Seen(const Mount& mount, const WorldSpec& world);

  // Those that it reads.
  std::span<const int> links() const { return links_; }
  // The world as it is now; what was read before is forgotten.
  void Begin(const Eyes& eyes);
  // The same `after` the last look.
  void GoOn(VirtualDuration after, const Eyes& eyes);
  // To the share `part` (0 to 1) of the time between the last two looks.
  void GoTo(double part);

  // How far a ray goes that leaves the mount in that direction of its frame.
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
