#include "coordinator/cli/fit_command.h"

#include <filesystem>
#include <system_error>
#include <variant>
#include <vector>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/print.h"
#include "coordinator/errors/visible.h"
#include "coordinator/fit/fit_table.h"
#include "coordinator/fit/fragment.h"
#include "coordinator/fit/measured_run.h"
#include "coordinator/os/files.h"

namespace tcs {

namespace fs = std::filesystem;

int FitCommand(const FitArguments& arguments) {
  const auto read = fit::ReadMeasuredRun(arguments.folder);
  if (const auto* error = std::get_if<LoadError>(&read)) return Fail(error->message);
  const auto& run = std::get<fit::MeasuredRun>(read);
  const std::vector<fit::ClientFit> fits = fit::FitAll(run);
  const std::string fragment = fit::FragmentOf(run, fits);
  if (!arguments.out.empty()) {
    std::error_code ignored;
    if (fs::exists(arguments.out, ignored) && !fs::is_regular_file(arguments.out, ignored)) {
      return Fail("'" + arguments.out +
                  "' is not a file; give --out the name of a file for the costs");
    }
    if (const std::string error = WriteWhole(arguments.out, fragment); !error.empty()) {
      return Fail(error);
    }
  }
  Print("{}", VisibleLines(fit::FitTable(run, fits)));
  if (arguments.out.empty()) {
    Print("\n{}", VisibleLines(fragment));
  } else {
    Print("written to {}: tcsim run SCENARIO --accounting fixed --overlay {}\n",
          Visible(arguments.out), Visible(arguments.out));
  }
  for (const std::string& warning : run.warnings) Say("warning: " + warning);
  for (const std::string& warning : fit::FitWarnings(run, fits)) Say("warning: " + warning);
  return kSucceeded;
}

}  // namespace tcs
