// The kernel's own user-space clock functions. Programs that call them past the C library (Go's
// runtime, the C library itself from inside) are led to the shim's.
#pragma once

namespace tcs::preload {

// Overwrites the entries of this process's vDSO with jumps. Once per program; nothing happens where
// the kernel does not let the vDSO be written.
void PatchVdso();

}  // namespace tcs::preload
