// The random numbers that programs draw from the system: under fixed accounting they repeat, each
// process with a seed of its own.
#pragma once

#include <sys/types.h>
#include <sys/uio.h>

#include <cstddef>

#include "shm/layout.h"

namespace tcs::preload {

// Starts the process's sequence anew and rewrites AT_RANDOM. Does nothing under measured
// accounting.
void SeedProcess(const shm::ThreadSlot& slot);

// True if the process has been given a seed.
bool DrawsRepeat();

// A read of `size` bytes into the buffers is over; negative: the read failed. Bytes from a file
// that the kernel fills with random numbers are replaced by draws that repeat, where draws do.
// Async-signal-safe; errno stays.
void RepeatDraws(int fd, const iovec* buffers, std::size_t count, ssize_t size);

}  // namespace tcs::preload
