// Reading URDF by its rules (urdf_rules.h): what follows them, and what does not.
#pragma once

#include <tinyxml2.h>

#include <memory>
#include <string>
#include <vector>

namespace tcs {

// A copy of `document` (ReadUrdfXml) that holds what is understood and nothing else, its numbers
// written plainly; lists in it have a single space between their numbers. Where an attribute is not
// a finite number, is missing, or is beyond its range, where an element is missing or stands twice,
// ModelMistake is thrown, "PATH:LINE: …". What is left out goes to `warnings`: a sentence for each
// kind, with the line on which it stands first.
std::unique_ptr<tinyxml2::XMLDocument> UnderstoodPart(const std::string& path,
                                                      const tinyxml2::XMLDocument& document,
                                                      std::vector<std::string>* warnings);

// "link 'arm'": the nearest link or joint that `element` is or stands in; else "the robot".
std::string OwnerOf(const tinyxml2::XMLElement& element);

}  // namespace tcs
