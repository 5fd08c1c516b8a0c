// The friction that a URDF file gives its links, in the elements of Gazebo and of PyBullet.
#pragma once

#include <tinyxml2.h>

#include <map>
#include <string>

namespace tcs {

// Coulomb's coefficient of each link, by name, that has <gazebo reference="LINK"><mu1> or
// <contact><lateral_friction value="…"/>. `document` comes from ReadUrdfXml.
std::map<std::string, double> FrictionOfLinks(const tinyxml2::XMLDocument& document);

// Whether there is nothing in an element <gazebo> of the robot, or <contact> of a link, but what
// FrictionOfLinks reads, and looks.
bool IsOnlyFriction(const tinyxml2::XMLElement& element);

}  // namespace tcs
