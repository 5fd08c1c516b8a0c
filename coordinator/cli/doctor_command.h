// `tcsim doctor`.
#pragma once

namespace tcs {

struct DoctorArguments {
  bool as_json = false;
  bool calibrates = false;  // measures this machine, too
};

// The exit status: 0 if runs are possible here.
int DoctorCommand(const DoctorArguments& arguments);

}  // namespace tcs
