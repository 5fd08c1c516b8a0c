// The block detector's loop, in a process that has no memory but two pages of its own.
//
// A process that runs only when nobody else wants the processor gets it about as rarely to die, or
// to begin. To unmap a library the process takes the kernel's lock of that file. Every process that
// starts or ends a program with the library waits for the lock meanwhile: with the C library, or
// its loader, that is every process on the machine. So the process gives up what it shares with
// others before it sinks to that level.
#pragma once

namespace tcs {

// Reads 8 bytes from descriptor 0 and then writes 8 to descriptor 1, again and again; ends once
// either fails. The process is scheduled by `policy` and `priority` once it has given up its
// memory, and until then as the caller was. For a process that has been forked for this and has one
// thread. Returns only if the memory cannot be had; nothing has changed then.
void RelayInBareProcess(int policy, int priority);

}  // namespace tcs
