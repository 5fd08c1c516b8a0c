// What the doctor found out about one thing that tcs needs of a machine.
#pragma once

#include <string>
#include <vector>

namespace tcs {

enum class Verdict {
  kOk,
  kWarning,  // tcs runs, but worse than it could
  kMissing,  // tcs cannot run
};

struct Finding {
  std::string name;
  Verdict verdict = Verdict::kOk;
  std::string found;
  std::string mend;  // one sentence; empty where all is well
};

}  // namespace tcs
