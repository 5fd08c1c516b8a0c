// Preconditions of the physics: a violated one is a bug of ours.
#pragma once

namespace tcs {

// Aborts with "tcs: bug: WHAT" unless `holds`.
void Require(bool holds, const char* what);

}  // namespace tcs
