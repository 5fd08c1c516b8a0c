// The commands that look at what runs have written, or start runs of their own: no such command
// flies. These commands are most of what there is to compile, so they are a program of their own,
// tcsim-tools, with the same main: a first flight does not wait for them. tcsim-tools is another
// program for those who build only; users call tcsim.
#pragma once

#include <string>
#include <variant>

#include "coordinator/cli/compare_command.h"
#include "coordinator/cli/doctor_command.h"
#include "coordinator/cli/dump_command.h"
#include "coordinator/cli/explain_command.h"
#include "coordinator/cli/fit_command.h"
#include "coordinator/cli/report_command.h"
#include "coordinator/cli/snapshot_command.h"
#include "coordinator/cli/topics_command.h"
#include "coordinator/cli/trace_command.h"
#include "coordinator/cli/trials_command.h"

namespace CLI {
class App;
}

namespace tcs {

// For the build: manual pages and completions of all commands, into that folder.
struct GenerateArguments {
  const CLI::App* app = nullptr;
  std::string folder;
};

// On a cluster's node: the work of trials in that folder.
struct SlurmJobArguments {
  std::string folder;
};

using ToolArguments =
    std::variant<CompareArguments, DoctorArguments, DumpArguments, ExplainArguments, FitArguments,
                 GenerateArguments, ReportArguments, SlurmJobArguments, SnapshotArguments,
                 TopicsArguments, TraceArguments, TrialsArguments>;

// Does the command, whose words are `argv`, and returns the exit status. In tcsim the process
// becomes tcsim-tools, and the call returns only if that program cannot be started
// (tools_elsewhere.cc); tcsim-tools does the command (tools_here.cc).
int DoWithTools(const ToolArguments& arguments, char** argv);

// Writes snapshot.yaml into the folder of a run that has stopped. The exit status; a failure has
// been said.
int WriteSnapshot(const std::string& folder);

}  // namespace tcs
