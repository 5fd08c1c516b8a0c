// `tcsim snapshot`.
#pragma once

#include <string>

namespace tcs {

struct SnapshotArguments {
  std::string from;  // DIR or DIR@TIME
  std::string out;   // empty: the snapshot is printed
};

// The exit status.
int SnapshotCommand(const SnapshotArguments& arguments);

}  // namespace tcs
