// How many files the coordinator may have open: as many as the kernel lets it, for it needs several
// for each process of a run. The programs have the limit that tcsim was started with.
#pragma once

#include <string>

namespace tcs {

// Once, before the first program is started. One thread only.
void RaiseOpenFileLimit();
// In a child that is about to become another program.
void RestoreOpenFileLimit();
// This one is open, and so few can be opened besides that no further process is to be followed: the
// run needs some for its end (a clock for its grace, /proc).
bool IsAmongLastFiles(int fd);
// For users: what it means that the limit is reached, and what to do.
std::string WhyNoFurtherFile();

}  // namespace tcs
