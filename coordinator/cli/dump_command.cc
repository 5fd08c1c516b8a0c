#include "coordinator/cli/dump_command.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/print.h"
#include "coordinator/dump/ask.h"
#include "coordinator/dump/find_run.h"
#include "coordinator/dump/kernel.h"
#include "coordinator/dump/outside.h"
#include "coordinator/dump/state_text.h"
#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kAnswersWithinNs = 2'000'000'000;

const char* NameOf(Doing doing) {
  switch (doing) {
    case Doing::kPrepares:
      return "prepares";
    case Doing::kSchedules:
      return "schedules";
    case Doing::kIntegrates:
      return "integrates";
    case Doing::kAwaitsThread:
      return "awaits thread";
    case Doing::kAwaitsEvents:
      return "awaits events";
    case Doing::kWrites:
      return "writes";
    case Doing::kEnds:
      break;
  }
  return "ends";
}

Json CoordinatorOf(const FoundRun& run, const StateAnswer& answer) {
  const CoordinatorState& state = answer.coordinator;
  return {{"doing", NameOf(state.doing)},
          {"since_host_ns", state.since_ns},
          {"host_cpu", state.host_cpu},
          {"dispatches", state.dispatches},
          {"dispatched_tid", state.dispatched_tid},
          {"dispatched_since_host_ns", state.dispatched_since_ns},
          {"virtual_ns", state.virtual_ns},
          {"waited_ns", answer.waited_ns},
          {"computed_ns", answer.computed_ns},
          {"tracer", TracerOf(run.coordinator)},
          {"kernel", KernelStateOf(run.coordinator, run.coordinator)}};
}

Json StateOf(const FoundRun& run, const StateAnswer& answer) {
  Json state = {{"answered", answer.text.has_value()}, {"coordinator", CoordinatorOf(run, answer)}};
  if (answer.text) {
    state.update(Json::parse(*answer.text));
    AddWhatTheKernelKnows(&state);
  } else {
    state["run"] = {{"folder", run.folder}};
    state["outside"] = SeenFromOutside(run);
  }
  // The coordinator as the asker knows it: the asker may see other numbers than the run.
  state["run"]["coordinator"] = run.coordinator;
  return state;
}

// The terminal's width; a file gets long lines.
std::size_t ColumnsOfStdout() {
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 1000;
}

}  // namespace

int DumpCommand(const DumpArguments& arguments) {
  if (std::getenv("TCS_SOCKET") != nullptr) {
    return Fail("a run cannot ask for its own state: call `tcsim dump` outside of it");
  }
  auto chosen = ChooseRun(FindRuns(), arguments.run);
  if (const auto* error = std::get_if<std::string>(&chosen)) return Fail(*error);
  const FoundRun& run = std::get<FoundRun>(chosen);
  const StateAnswer answer = AskForState(run, kAnswersWithinNs);
  if (!answer.error.empty()) return Fail(answer.error);
  try {
    const Json state = StateOf(run, answer);
    Print("{}", arguments.as_json ? state.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"
                                  : StateText(state, ColumnsOfStdout()));
  } catch (const Json::exception&) {
    // Any process that may ask may also write into the answer.
    return Fail("the run's answer is damaged: another process has written to it; ask again");
  }
  return kSucceeded;
}

}  // namespace tcs
