// Reads URDF by its rules (urdf_rules.h): finds which parts follow them, and which do not.
#pragma once

#include <tinyxml2.h>

#include <memory>
#include <string>

#include "coordinator/models/urdf_notes.h"

namespace tcs {

// A copy of `document` (ReadUrdfXml) that holds what is understood and nothing else, its numbers
// written plainly; lists in it have a single space between their numbers. Each element of the copy
// knows the element that it was made of, which outlives it. Where an attribute is not a finite
// number, is missing, or is beyond its range, where an element is missing, that is a mistake in
// `notes`, and the copy lacks it. Parts that are left out are warnings there: a sentence for each
// kind, with the line on which it stands first.
std::unique_ptr<tinyxml2::XMLDocument> UnderstoodPart(const tinyxml2::XMLDocument& document,
                                                      UrdfNotes* notes);

// The line of the file on which an element of the copy stands, or what it was put into.
int LineOf(const tinyxml2::XMLElement& understood);

// "link 'arm'": the nearest link or joint that `element` is or stands in; else "the robot".
std::string OwnerOf(const tinyxml2::XMLElement& element);

}  // namespace tcs
