// A question that the shim asks by an operation of futex(2) that the kernel does not know, as those
// of KeepFiles (layout.h): the call is always handed over, and answered at once.
#pragma once

#include <cstdint>

namespace tcs::shm {

// Whether no other descriptor, in any process of the run, is of the file of the descriptor in the
// third argument: 1, or 0 where there is one.
inline constexpr std::uint32_t kIsLastDescriptor = 0x7c570003;

}  // namespace tcs::shm
