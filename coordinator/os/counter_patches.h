// Leads reads of the processor's cycle counter in a program without the shim to the kernel's clock,
// whose calls are trapped. In a program with the shim, the shim does that
// (libtcs_preload/cycle_counter/).
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace tcs {

// The patches for a statically linked program that has just begun.
struct CounterPatches {
  struct Patch {
    std::uint64_t address = 0;  // in the program's file
    std::vector<std::uint8_t> bytes;
  };
  std::vector<Patch> patches;       // in this order
  std::vector<std::uint64_t> left;  // addresses of reads that stay as they were
};

// The patches for the program in that file. `ticks_per_ns_q32`: of the counter. Empty also for a
// file that is no such program.
CounterPatches PatchesOf(const std::string& executable, std::uint64_t ticks_per_ns_q32);

// Writes the patches to the process, which must be stopped at its begin. `first_left` becomes the
// address of the first of `left` in the process; 0: there is none. False if the kernel does not let
// us.
bool WritePatches(pid_t pid, const CounterPatches& patches, std::uint64_t* first_left);

}  // namespace tcs
