#include "coordinator/cli/snapshot_command.h"

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <variant>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/print.h"
#include "coordinator/cli/stop_at.h"
#include "coordinator/errors/visible.h"
#include "coordinator/os/files.h"
#include "coordinator/scenario/duration.h"
#include "coordinator/snapshot/recorded_state.h"
#include "coordinator/snapshot/world_snapshot.h"

namespace tcs {
int SnapshotCommand(const SnapshotArguments& arguments) {
  const auto [folder, time] = FolderAndTime(arguments.from);
  std::optional<std::int64_t> at_ns;
  if (!time.empty()) {
    const auto parsed = ParseDuration(time);
    if (const auto* error = std::get_if<LoadError>(&parsed)) {
      return Fail(arguments.from + ": " + error->message);
    }
    at_ns = std::get<VirtualDuration>(parsed).ns();
  }
  const auto world = snapshot::WorldAt(folder, at_ns);
  if (const auto* error = std::get_if<LoadError>(&world)) return Fail(error->message);
  const auto& text = std::get<std::string>(world);
  if (arguments.out.empty()) {
    Print("{}", text);
    return kSucceeded;
  }
  if (const std::string error = WriteWhole(arguments.out, text); !error.empty()) return Fail(error);
  Print("written: {}; `tcsim run SCENARIO --overlay` it begins from there\n",
        Visible(arguments.out));
  return kSucceeded;
}

}  // namespace tcs
