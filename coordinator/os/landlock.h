// The kernel's sandbox for programs, Landlock.
#pragma once

#include <cstdint>

namespace tcs {

// Whether a call of landlock_create_ruleset(attributes, size, flags) asks for Landlock's version.
bool AsksForLandlockVersion(const std::uint64_t (&arguments)[6]);

// The answer to a program that asks, negative for an errno. Since version 6 a program can cut
// itself off from abstract sockets of others. The program's new threads and children would then not
// reach the coordinator, so programs are told of no later version than 5.
std::int64_t LandlockVersionForPrograms();

}  // namespace tcs
