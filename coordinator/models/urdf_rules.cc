#include "coordinator/models/urdf_rules.h"

namespace tcs::urdf_rules {
namespace {

const Rule kOrigin{"origin", {{"xyz", Kind::kThree, false}, {"rpy", Kind::kThree, false}}};
const Rule kMass{"mass", {{"value", Kind::kNotNegative}}};
const Rule kInertia{"inertia",
                    {{"ixx", Kind::kNumber},
                     {"ixy", Kind::kNumber, false},
                     {"ixz", Kind::kNumber, false},
                     {"iyy", Kind::kNumber},
                     {"iyz", Kind::kNumber, false},
                     {"izz", Kind::kNumber}}};
const Rule kInertial{"inertial", {}, {{&kOrigin, 0, 1}, {&kMass, 1, 1}, {&kInertia, 1, 1}}};

const Rule kBox{"box", {{"size", Kind::kThreeNotNegative}}};
const Rule kSphere{"sphere", {{"radius", Kind::kNotNegative}}};
const Rule kCylinder{"cylinder", {{"radius", Kind::kNotNegative}, {"length", Kind::kNotNegative}}};
const Rule kCapsule{"capsule", {{"radius", Kind::kNotNegative}, {"length", Kind::kNotNegative}}};
const Rule kMesh{"mesh", {{"filename", Kind::kFile}, {"scale", Kind::kThree, false}}};
const Rule kGeometry{
    "geometry",
    {},
    {{&kBox, 0, 1}, {&kSphere, 0, 1}, {&kCylinder, 0, 1}, {&kCapsule, 0, 1}, {&kMesh, 0, 1}},
    true};
const Rule kCollision{
    "collision", {{"name", Kind::kName, false}}, {{&kOrigin, 0, 1}, {&kGeometry, 1, 1}}};
}  // namespace

const Rule kLink{"link",
                 {{"name", Kind::kName}},
                 {{&kInertial, 0, 1}, {&kCollision, 0, kAnyNumber}},
                 false,
                 {"visual"}};

namespace {

const Rule kParent{"parent", {{"link", Kind::kName}}};
const Rule kChild{"child", {{"link", Kind::kName}}};
const Rule kAxis{"axis", {{"xyz", Kind::kThree}}};
const Rule kLimit{"limit",
                  {{"lower", Kind::kNumber, false},
                   {"upper", Kind::kNumber, false},
                   {"effort", Kind::kNumber, false},
                   {"velocity", Kind::kNumber, false}}};
const Rule kDynamics{
    "dynamics", {{"damping", Kind::kNotNegative, false}, {"friction", Kind::kNotNegative, false}}};
const Rule kMimic{"mimic",
                  {{"joint", Kind::kName},
                   {"multiplier", Kind::kNumber, false},
                   {"offset", Kind::kNumber, false}}};
}  // namespace

const Rule kJoint{"joint",
                  {{"name", Kind::kName}, {"type", Kind::kName}},
                  {{&kOrigin, 0, 1},
                   {&kParent, 1, 1},
                   {&kChild, 1, 1},
                   {&kAxis, 0, 1},
                   {&kLimit, 0, 1},
                   {&kDynamics, 0, 1},
                   {&kMimic, 0, 1}}};
const Rule kRobot{"robot",
                  {{"name", Kind::kName, false}},
                  {{&kLink, 1, kAnyNumber}, {&kJoint, 0, kAnyNumber}},
                  false,
                  {"material"}};

}  // namespace tcs::urdf_rules
