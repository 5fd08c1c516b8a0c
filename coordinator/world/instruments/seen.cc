#include "coordinator/world/instruments/seen.h"

#include <algorithm>

#include "simbody_bridge/link_motion.h"

namespace tcs {

Seen::Seen(const Mount& mount, const WorldSpec& world) : mount_(mount), scene_(world, mount.link) {
  links_.assign(scene_.links().begin(), scene_.links().end());
  links_.push_back(mount.link);
  to_.resize(links_.size());
  poses_.resize(scene_.links().size());
}

void Seen::Read(const Eyes& eyes) { eyes.links(links_, to_); }

void Seen::Begin(const Eyes& eyes) {
  Read(eyes);
  from_ = to_;
  all_is_still_ = false;
  GoTo(0);
}

void Seen::GoOn(VirtualDuration after, const Eyes& eyes) {
  std::swap(from_, to_);
  to_.resize(links_.size());
  Read(eyes);
  seconds_ = after.seconds();
  all_is_still_ = false;
  GoTo(0);
  all_is_still_ = std::equal(from_.begin(), from_.end(), to_.begin(), IsStill);
}

bool Seen::IsStill(const LinkState& from, const LinkState& to) { return from.pose == to.pose; }

void Seen::GoTo(double part) {
  if (all_is_still_) return;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = PoseBetween(from_[i], to_[i], seconds_, part);
  }
  scene_.Place(poses_);
  eye_ = Times(PoseBetween(from_.back(), to_.back(), seconds_, part), mount_.at);
}

double Seen::Cast(const std::array<double, 3>& direction) const {
  return scene_.Cast({eye_.position_m, Rotate(eye_.orientation_xyzw, direction)});
}

}  // namespace tcs
