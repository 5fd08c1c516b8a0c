#include "coordinator/world/instruments/on_link.h"

#include <algorithm>
#include <cmath>

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

Gnss::Gnss(const GnssSpec& spec) : spec_(spec) {
  measured_.frame = spec.mount.frame;
  measured_.origin = spec.origin;
}

void Gnss::Look(int, VirtualTime, const Eyes& eyes) {
  measured_.enu_m = LookAt(spec_.mount, eyes).pose.position_m;
}

Magnetometer::Magnetometer(const MagnetometerSpec& spec) : spec_(spec) {
  measured_.frame = spec.mount.frame;
}

void Magnetometer::Look(int, VirtualTime, const Eyes& eyes) {
  measured_.field_t = InBody(LookAt(spec_.mount, eyes).pose.orientation_xyzw, spec_.field_t);
}

Barometer::Barometer(const BarometerSpec& spec) : spec_(spec) {
  measured_.frame = spec.mount.frame;
}

void Barometer::Look(int, VirtualTime, const Eyes& eyes) {
  measured_.pressure_pa = PressureAt(LookAt(spec_.mount, eyes).pose.position_m[2], spec_.ground_pa);
}

// ISA's troposphere: 288.15 K on the ground, and 6.5 K less each kilometre.
double PressureAt(double height_m, double ground_pa) {
  constexpr double kGroundK = 288.15, kLapseKpm = 0.0065, kExponent = 5.25588;
  return ground_pa * std::pow(std::max(0.0, 1 - kLapseKpm * height_m / kGroundK), kExponent);
}

}  // namespace tcs
