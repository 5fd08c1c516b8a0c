// What programs draw from the system: under fixed accounting it repeats, each process with a seed
// of its own.
#pragma once

#include <stdio.h>
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

// A read of `size` bytes into the buffers is over; negative: it failed. What came from /dev/random
// or /dev/urandom is replaced by draws that repeat, where they do. Async-signal-safe; errno stays.
void RepeatDraws(int fd, const iovec* buffers, std::size_t count, ssize_t size);
// The same of a stream that has just been opened, and whose reads are the C library's own: it gets
// a file of draws, a megabyte of them. May be null, which stays so.
FILE* RepeatDraws(FILE* stream);

}  // namespace tcs::preload
