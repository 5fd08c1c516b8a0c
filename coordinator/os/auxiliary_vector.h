// The auxiliary vector, which the kernel gives a program at its start (getauxval(3)), of any
// process.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>

namespace tcs {

// The values by kind (AT_BASE and so on); empty: the vector cannot be read.
std::map<std::uint64_t, std::uint64_t> ReadAuxiliaryVector(pid_t pid);

}  // namespace tcs
