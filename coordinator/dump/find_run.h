// The runs that go on on this machine, and the one that a user means. Reads /proc, and finds the
// runs that the kernel lets the caller look into: those that the same user has started, and for
// root all.
#pragma once

#include <sys/types.h>

#include <string>
#include <variant>
#include <vector>

#include "coordinator/port/unique_fd.h"

namespace tcs {

struct FoundRun {
  pid_t coordinator = 0;  // its number for this process
  std::string folder;     // of the run's results, as the run knows it; empty: there is none
  UniqueFd memory;        // state_page.h, for reading and writing
};

// The runs that the caller may ask.
[[nodiscard]] std::vector<FoundRun> FindRuns();

// The one of `runs` that `named` means: a folder, the number of a process of the run, or of a
// process that has started the run; empty: the only run. Or one sentence on why there is no such
// run.
[[nodiscard]] std::variant<FoundRun, std::string> ChooseRun(std::vector<FoundRun> runs,
                                                            const std::string& named);

}  // namespace tcs
