// The kernel's own user-space clock functions. A program that calls them past the C library's
// symbols (Go's runtime, the C library itself from inside) is led to the shim's functions.
#pragma once

namespace tcs::preload {

// Overwrites the entries of this process's vDSO with jumps. Once per program, before it has
// threads; a child by fork inherits them. Nothing happens where the kernel does not let the vDSO be
// written.
void PatchVdso();

}  // namespace tcs::preload
