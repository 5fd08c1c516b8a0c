// `tcsim doctor`.
#pragma once

namespace tcs {

struct DoctorArguments {
  bool as_json = false;
};

// The exit status: 0 if runs are possible here.
int DoctorCommand(const DoctorArguments& arguments);

}  // namespace tcs
