#include "coordinator/cli/doctor_command.h"

#include <unistd.h>

#include <cstdlib>
#include <vector>

#include "coordinator/cli/preload_library.h"
#include "coordinator/cli/print.h"
#include "coordinator/doctor/doctor.h"

namespace tcs {

int DoctorCommand(const DoctorArguments& arguments) {
  std::vector<Finding> findings = Examine(PreloadLibrary());
  if (arguments.calibrates) findings.push_back(Calibrate());
  const bool colour = isatty(STDOUT_FILENO) == 1 && getenv("NO_COLOR") == nullptr;
  Print("{}", arguments.as_json ? ToJson(findings) : ToText(findings, colour));
  return CanRun(findings) ? 0 : 1;
}

}  // namespace tcs
