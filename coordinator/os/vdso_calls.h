// A program that was begun without the shim reads the clock from the kernel's page beside it (the
// vDSO), where no trap sees it. The functions of the vDSO are made to call the kernel instead,
// whose calls are trapped.
#pragma once

#include <sys/types.h>

namespace tcs {

// Writes to the vDSO of the process, which must be stopped. False if the kernel does not let us.
bool MakeVdsoCall(pid_t pid);

}  // namespace tcs
