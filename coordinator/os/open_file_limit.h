// How many files the coordinator may have open: as many as the kernel permits, for the coordinator
// needs several for each process of a run. The programs have the limit that tcsim was started with.
#pragma once

#include <string>

namespace tcs {

// Called once, before the first program is started. For one thread only.
void RaiseOpenFileLimit();
// Called in a child that is about to become another program.
void RestoreOpenFileLimit();
// `fd` is open, and so few files can be opened besides that no further process is to be followed:
// the run needs some for its end (a clock for its grace, /proc).
bool IsAmongLastFiles(int fd);
// For users: the meaning of a limit that is reached, and what to do.
std::string WhyNoFurtherFile();

}  // namespace tcs
