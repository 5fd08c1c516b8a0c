// Where the kernel lets the coordinator copy no descriptors of clients (RunHeader::has_brokers) a
// process of the shim's own, beside each client, hands them over (shm/attach_protocol.h). That
// process, the broker, shares the client's memory and its table of descriptors and nothing else: it
// is no thread, so a program that counts its threads finds the number that it expects; it is not
// the program's child, so no wait() finds it, not even with __WALL; and it has a session of its
// own.
//
// The broker's code runs without anything of the C library's: no errno, no thread-local variables,
// no lock.
#pragma once

#include "libtcs_preload/guest.h"

namespace tcs::preload {

// Makes the process's broker, which answers at g_broker_fd, and returns once it is there. Nothing
// happens where another thread is at it. Ends the process if there can be none.
// Async-signal-safe.
void MakeBroker();

// Makes the process's broker if there is none: the coordinator has ended it because the process was
// about to execute another program, or another process has ended it. For the beginning of each
// call.
inline void KeepBroker() {
  if (g_header->has_brokers != 0 && g_process->broker.load(std::memory_order_relaxed) == 0) {
    MakeBroker();
  }
}

}  // namespace tcs::preload
