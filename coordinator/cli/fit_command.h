// `tcsim fit`.
#pragma once

#include <string>

namespace tcs {

struct FitArguments {
  std::string folder;
  std::string out;  // a file; empty: the costs are printed
};

// The exit status.
int FitCommand(const FitArguments& arguments);

}  // namespace tcs
