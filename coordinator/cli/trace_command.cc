#include "coordinator/cli/trace_command.h"

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/print.h"
#include "coordinator/errors/visible.h"
#include "coordinator/perfetto/perfetto_trace.h"

namespace tcs {

int TraceCommand(const TraceArguments& arguments) {
  const std::string out =
      arguments.out.empty() ? arguments.folder + "/trace.json.gz" : arguments.out;
  if (const std::string error = perfetto::WriteTrace(arguments.folder, out); !error.empty()) {
    return Fail(error);
  }
  Print("written: {}; open it at ui.perfetto.dev\n", Visible(out));
  return kSucceeded;
}

}  // namespace tcs
