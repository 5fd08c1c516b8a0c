#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/basics/version.h"
#include "coordinator/cli/manual/generate.h"
#include "coordinator/cli/print.h"
#include "coordinator/cli/tools.h"
#include "coordinator/os/files.h"
#include "coordinator/snapshot/world_snapshot.h"
#include "coordinator/trials/slurm/slurm_job.h"

namespace tcs {

namespace {

int Do(const CompareArguments& arguments) { return FlushStdout(CompareCommand(arguments)); }
int Do(const DoctorArguments& arguments) { return FlushStdout(DoctorCommand(arguments)); }
int Do(const DumpArguments& arguments) { return FlushStdout(DumpCommand(arguments)); }
int Do(const ExplainArguments& arguments) { return FlushStdout(ExplainCommand(arguments)); }
int Do(const FitArguments& arguments) { return FlushStdout(FitCommand(arguments)); }
int Do(const GenerateArguments& arguments) {
  return Generate(Describe(*arguments.app), arguments.folder);
}
int Do(const ReportArguments& arguments) { return FlushStdout(ReportCommand(arguments)); }
int Do(const SlurmJobArguments& arguments) { return RunSlurmJob(arguments.folder, kVersion); }
int Do(const SnapshotArguments& arguments) { return FlushStdout(SnapshotCommand(arguments)); }
int Do(const TopicsArguments& arguments) { return FlushStdout(TopicsCommand(arguments)); }
int Do(const TraceArguments& arguments) { return FlushStdout(TraceCommand(arguments)); }
int Do(const TrialsArguments& arguments) { return TrialsCommand(arguments); }

}  // namespace

int DoWithTools(const ToolArguments& arguments, char** /*argv*/) {
  return std::visit([](const auto& command) { return Do(command); }, arguments);
}

int WriteSnapshot(const std::string& folder) {
  const auto world = snapshot::WorldAt(folder, std::nullopt);
  if (const auto* error = std::get_if<LoadError>(&world)) return Fail(error->message);
  const std::string error = WriteWhole(folder + "/snapshot.yaml", std::get<std::string>(world));
  return error.empty() ? kSucceeded : Fail(error);
}

}  // namespace tcs
