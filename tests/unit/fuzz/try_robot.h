// A robot's file that may be damaged: loaded, and moved on each engine.
#pragma once

#include <string>

#include "shm/virtual_time.h"

namespace tcs::fuzz {

// What is wrong with how it went, or nothing: it is refused in sentences that begin with one of the
// two paths, or taken and moved for `moved` on each engine, which may refuse it in one sentence.
std::string TryRobot(const std::string& urdf, const std::string& damaged, VirtualDuration moved,
                     bool* refused);

}  // namespace tcs::fuzz
