// The pairs of links that a file of MoveIt (SRDF) says never to check for collision.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tcs {

// The two links of each <disable_collisions> in the file `path` (absolute). Throws ModelMistake,
// "PATH:LINE: …", for a file that is no SRDF.
std::vector<std::pair<std::string, std::string>> DisabledCollisions(const std::string& path);

}  // namespace tcs
