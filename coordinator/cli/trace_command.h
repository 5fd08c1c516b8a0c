// `tcsim trace`.
#pragma once

#include <string>

namespace tcs {

struct TraceArguments {
  std::string folder;
  std::string out;  // empty: trace.json.gz in the folder
};

// The exit status.
int TraceCommand(const TraceArguments& arguments);

}  // namespace tcs
