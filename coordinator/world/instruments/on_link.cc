#include "coordinator/world/instruments/on_link.h"

#include "simbody_bridge/frames.h"
#include "simbody_bridge/link_motion.h"

namespace tcs {

LinkState LookAt(const Mount& mount, const Eyes& eyes) {
  LinkState state;
  eyes.links({&mount.link, 1}, {&state, 1});
  return Mounted(state, mount.at);
}

Imu::Imu(const ImuSpec& spec, const std::array<double, 3>& gravity_mps2)
    : spec_(spec), felt_(gravity_mps2) {
  measured_.frame = spec.mount.frame;
}

void Imu::Look(int, VirtualTime now, const Eyes& eyes) {
  const LinkState frame = LookAt(spec_.mount, eyes);
  measured_.orientation_xyzw = frame.pose.orientation_xyzw;
  measured_.felt = felt_.Sample(now, frame);
}

Truth::Truth(const TruthSpec& spec) : spec_(spec) {
  measured_.frame = spec.world_frame;
  measured_.child_frame = spec.mount.frame;
}

void Truth::Look(int, VirtualTime, const Eyes& eyes) {
  const LinkState frame = LookAt(spec_.mount, eyes);
  measured_.pose = frame.pose;
  measured_.linear_mps = InBody(frame.pose.orientation_xyzw, frame.linear_velocity_mps);
  measured_.angular_radps = InBody(frame.pose.orientation_xyzw, frame.angular_velocity_radps);
}

}  // namespace tcs
