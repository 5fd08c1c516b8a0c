// The runs that go on on this machine, and the one that somebody means. Reads /proc: what is found
// is what the kernel lets the caller look into, which is what the same user has started, and for
// root everything.
#pragma once

#include <sys/types.h>

#include <string>
#include <variant>
#include <vector>

#include "coordinator/port/unique_fd.h"

namespace tcs {

struct FoundRun {
  pid_t coordinator = 0;  // as this process knows it
  std::string folder;     // of its results, as the run knows it; empty: it has none
  UniqueFd memory;        // state_page.h, for reading and writing
};

// All that the caller may ask.
[[nodiscard]] std::vector<FoundRun> FindRuns();

// Of those the one that `named` means: a folder, the number of a process of the run, or of one that
// has started it; empty: the only one. Or why there is no such, as one sentence.
[[nodiscard]] std::variant<FoundRun, std::string> ChooseRun(std::vector<FoundRun> runs,
                                                            const std::string& named);

}  // namespace tcs
