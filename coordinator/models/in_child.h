// Work on a file from others, with a library that may not survive it.
#pragma once

#include <functional>
#include <string>

namespace tcs {

struct ChildWork {
  std::string result;  // returned by `work`
  std::string
      failure;  // why there is none: half a sentence ("it took more than 20 s"); empty: none
};

// Runs `work` in a process of its own, which has `most_seconds` of processor time, ten times as
// much in all, and 1 GiB of memory beyond what this one has. The process's stderr goes nowhere, and
// at most `most_bytes` of its result are taken. The process is gone when this function returns, or
// when the calling process ends. Nothing else may wait for children meanwhile.
ChildWork DoInChild(const std::function<std::string()>& work, unsigned most_seconds,
                    std::size_t most_bytes);

}  // namespace tcs
