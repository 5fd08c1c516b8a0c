// Leads reads of the processor's cycle counter in a program without the shim to the kernel's clock,
// whose calls are trapped. In a program with the shim that does it (libtcs_preload/cycle_counter/).
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace tcs {

// What is to be written into a statically linked program that has just begun.
struct CounterPatches {
  struct Patch {
    std::uint64_t address = 0;  // in its file
    std::vector<std::uint8_t> bytes;
  };
  std::vector<Patch> patches;       // in this order
  std::vector<std::uint64_t> left;  // addresses of reads that are as they were
};

// For the program in that file. `ticks_per_ns_q32`: of the counter. Empty also for what is no such
// program.
CounterPatches PatchesOf(const std::string& executable, std::uint64_t ticks_per_ns_q32);

// Writes them to the process, which must be stopped at its begin. The address of the first of
// `left` in it; 0: there is none. False if the kernel does not let us.
bool WritePatches(pid_t pid, const CounterPatches& patches, std::uint64_t* first_left);

}  // namespace tcs
