#include "simbody_bridge/simbody/tree/link_force.h"

#include "simbody_bridge/simbody/vectors.h"

namespace tcs {

void LinkForce::calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                          SimTK::Vector_<SimTK::Vec3>& /*particle_forces*/,
                          SimTK::Vector& /*mobility_forces*/) const {
  for (std::size_t i = 0; i < forest_.links.size(); ++i) {
    const TreeLink& link = forest_.links[i];
    if (link.body == kWorldBody) continue;
    const Wrench& in_world = WrenchOnLink(acting_, i, WrenchFrame::kWorld);
    const Wrench& in_link = WrenchOnLink(acting_, i, WrenchFrame::kLink);
    if (in_world == Wrench{} && in_link == Wrench{}) continue;
    const SimTK::MobilizedBody& body = BodyAt(link.body);
    const SimTK::Rotation of_body = body.getBodyRotation(state);
    const SimTK::Rotation turn = of_body * ToRotation(link.pose.orientation_xyzw);
    const SimTK::Vec3 force = ToVec3(in_world.force_n) + turn * ToVec3(in_link.force_n);
    const SimTK::Vec3 torque = ToVec3(in_world.torque_nm) + turn * ToVec3(in_link.torque_nm);
    const SimTK::Vec3 arm = of_body * ToVec3(link.pose.position_m);
    body_forces[body.getMobilizedBodyIndex()] += SimTK::SpatialVec(torque + arm % force, force);
  }
}

}  // namespace tcs
