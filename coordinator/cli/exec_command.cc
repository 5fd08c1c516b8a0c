#include "coordinator/cli/exec_command.h"

#include <poll.h>
#include <time.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/duration_option.h"
#include "coordinator/os/say.h"
#include "coordinator/scenario/executable.h"
#include "coordinator/scenario/load_outside.h"
#include "coordinator/scenario/load_prices.h"

namespace tcs {

namespace {

// A day, as nanoseconds since 1970.
std::optional<std::int64_t> ParseDate(const std::string& text) {
  tm day{};
  const char* end = strptime(text.c_str(), "%Y-%m-%d", &day);
  if (end == nullptr || *end != '\0' || day.tm_year <= 70 || day.tm_year >= 200) {
    return std::nullopt;
  }
  return std::int64_t{timegm(&day)} * 1'000'000'000;
}

// Where the clocks begin.
std::string TakeOrigins(const ExecArguments& arguments, RunOptions* options) {
  std::optional<VirtualDuration> uptime;
  if (std::string error = TakeDuration("uptime", arguments.uptime, &uptime); !error.empty()) {
    return error;
  }
  constexpr std::int64_t kMostNs = 100LL * 365 * 86'400 * 1'000'000'000;
  if (uptime.has_value()) {
    if (uptime->ns() > kMostNs) return "--uptime: at most 100 years";
    options->uptime_ns = uptime->ns();
  }
  if (arguments.date.empty()) return {};
  options->date_ns = ParseDate(arguments.date);
  return options->date_ns.has_value()
             ? std::string()
             : "--date: '" + arguments.date + "' is not a day from 1971 to 2099 as 2005-03-18";
}

// A constant, or the median and the 99th percentile.
std::string TakeWakeup(const std::string& text, WakeupSpec* wakeup) {
  const std::size_t comma = text.find(',');
  const bool differs = comma != std::string::npos;
  std::optional<VirtualDuration> median, p99;
  std::string error = TakeDuration("wakeup", text.substr(0, comma), &median,
                                   differs ? Zero::kRefused : Zero::kAllowed);
  if (differs && error.empty()) error = TakeDuration("wakeup", text.substr(comma + 1), &p99);
  if (!error.empty()) return error;
  if (differs && (!median.has_value() || !p99.has_value() || *p99 < *median))
    return "--wakeup: '" + text + "' is not a median and a greater 99th percentile as 20us,80us";
  if (!median.has_value()) return {};
  *wakeup = {*median, p99.value_or(*median)};
  return wakeup->p99 > WakeupSpec::kLongest ? "--wakeup: '" + text + "' is more than 1 s"
                                            : std::string();
}

// Says warnings as they come, in the order in which they come. The program has the same stderr: so
// tcsim writes one line at a time, and none where the write might have to wait until somebody reads
// what is there. A pipe that polls as writable has room for PIPE_BUF bytes, more than a line; a
// terminal's output has not been stopped.
class WarningsAsTheyCome {
 public:
  void Take(const std::string& warning) {
    pollfd terminal{STDERR_FILENO, POLLOUT, 0};
    waits_ = waits_ || poll(&terminal, 1, 0) != 1 || (terminal.revents & POLLOUT) == 0;
    if (waits_) return;
    Say("warning: " + warning);
    ++said_;
  }
  // Says the warnings that had to wait.
  void SayTheRestOf(const std::vector<std::string>& warnings) const {
    for (std::size_t i = said_; i < warnings.size(); ++i) Say("warning: " + warnings[i]);
  }

 private:
  bool waits_ = false;
  std::size_t said_ = 0;
};

}  // namespace

int ExecCommand(const ExecArguments& arguments, const RunOptions& plain_options) {
  RunOptions options = plain_options;
  if (const std::string error = TakeOrigins(arguments, &options); !error.empty()) {
    return Fail(error);
  }
  const std::vector<std::string>& command = arguments.command;
  std::optional<VirtualDuration> call_cost, allocation_cost, outside_takes, patience;
  if (const std::string error = TakeDuration("call-cost", arguments.call_cost, &call_cost);
      !error.empty()) {
    return Fail(error);
  }
  if (const std::string error = TakeDuration("allocation-cost", arguments.allocation_cost,
                                             &allocation_cost, Zero::kAllowed);
      !error.empty()) {
    return Fail(error);
  }
  WakeupSpec wakeup;
  if (const std::string error = TakeWakeup(arguments.wakeup, &wakeup); !error.empty()) {
    return Fail(error);
  }
  std::optional<LoadResult<PriceList>> prices;
  if (arguments.costs == "none") {
    prices = NoPrices();
  } else if (!arguments.costs.empty()) {
    prices = LoadPriceFile(arguments.costs);
  }
  if (prices.has_value()) {
    if (const auto* error = std::get_if<LoadError>(&*prices))
      return Fail("--costs: " + error->message);
  }
  if (const std::string error =
          TakeDuration("outside-takes", arguments.outside_takes, &outside_takes);
      !error.empty()) {
    return Fail(error);
  }
  if (const std::string error = TakeDuration("patience", arguments.patience, &patience);
      !error.empty()) {
    return Fail(error);
  }
  std::error_code gone;
  const std::string folder = std::filesystem::current_path(gone);
  if (gone) return Fail("the current folder does not exist any more; change to another folder");
  auto found = FindExecutable(command[0], folder);
  if (const auto* error = std::get_if<LoadError>(&found))
    return Fail(error->message, kNoSuchProgram);
  if (auto error = CheckExecutable(std::get<std::string>(found))) return Fail(error->message);

  Scenario scenario;
  scenario.duration = VirtualDuration::Nanoseconds(shm::kNeverNs);
  if (patience.has_value()) scenario.patience = HostDuration::Nanoseconds(patience->ns());
  ClientSpec client;
  client.name = command[0];
  client.command = command;
  client.patch_vdso = arguments.patch_vdso;
  client.cycle_counter = arguments.cycle_counter;
  client.dds = arguments.dds;
  if (call_cost.has_value()) client.fixed_call_cost = *call_cost;
  for (const std::string& text : arguments.outside) {
    const std::string mistake = TakeOutsideName(text, folder, &client.outside.names.emplace_back());
    if (!mistake.empty()) return Fail("--outside '" + text + "' " + mistake);
  }
  if (outside_takes.has_value()) client.outside.takes = *outside_takes;
  if (allocation_cost.has_value()) client.fixed_allocation_cost = *allocation_cost;
  RobotSpec& computer = scenario.robots.emplace_back();
  computer.name = "computer";
  computer.cores = arguments.cores;
  computer.speed = arguments.speed;
  computer.wakeup = wakeup;
  if (prices.has_value()) {
    computer.prices = std::get<PriceList>(*prices);
    computer.prices_are_hosts = false;
  }
  computer.clients = {client};
  options.on_notice = [](const std::string& notice) { Say(notice); };
  WarningsAsTheyCome warnings;
  options.on_warning = [&warnings](const std::string& warning) { warnings.Take(warning); };
  const RunReport report = RunScenario(scenario, options);
  warnings.SayTheRestOf(report.warnings);
  if (!report.error.empty()) return Fail(report.error);
  return report.interrupted ? InterruptedBy(report.stop_signal) : report.exit_status;
}

}  // namespace tcs
