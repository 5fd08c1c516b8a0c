// The meaning of files in the field where they do not follow the letter of URDF: they are read as
// the field's other tools read them (urdfdom, RViz, MuJoCo, PyBullet), and that is said once.
#pragma once

#include <tinyxml2.h>

#include <cstddef>

#include "coordinator/models/urdf_notes.h"

namespace tcs {

inline constexpr std::size_t kMostLinks = 4096;  // and joints: of a file

// The attribute that a joint gets that cannot move: the position at which it stands.
inline constexpr char kLockedAt[] = "locked-at";
// The attribute that a <cylinder> gets that is a capsule.
inline constexpr char kIsCapsule[] = "is-capsule";

// Changes a document of UnderstoodPart so that liburdfdom takes it: sizes of 0, ranges that are
// none, leaders that do not move, links that no joint names … A part without meaning is a mistake
// in `notes`. Afterwards
//   an <limit> has `lower` or `upper` only if the joint has a range, and effort and velocity are 0
//   where they are not limited;
//   a <mimic> follows a joint with one coordinate that follows none itself;
//   a joint with kLockedAt stands still.
void WithCustoms(tinyxml2::XMLDocument* understood, UrdfNotes* notes);

}  // namespace tcs
