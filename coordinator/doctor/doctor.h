// `tcsim doctor`: what this machine allows, and how to mend what it does not.
#pragma once

#include <string>
#include <vector>

#include "coordinator/doctor/finding.h"

namespace tcs {

// Looks, and tries what can be tried; takes well under a second and leaves nothing behind.
std::vector<Finding> Examine(const std::string& preload_library);

// How long this machine takes to wake a thread, as a scenario has it for a robot's computer. Takes
// two seconds, and says nothing useful of a machine that is busy.
Finding Calibrate();

// One line a finding, or a JSON array. Colours where `colour` says so.
std::string ToText(const std::vector<Finding>& findings, bool colour);
std::string ToJson(const std::vector<Finding>& findings);

// False if something is missing that tcs cannot run without.
bool CanRun(const std::vector<Finding>& findings);

}  // namespace tcs
