#include "coordinator/trials/runner.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <list>
#include <system_error>
#include <utility>

#include "coordinator/os/cpu_places.h"
#include "coordinator/os/files.h"
#include "coordinator/os/host.h"
#include "coordinator/os/stop_request.h"
#include "coordinator/os/unique_fd.h"
#include "coordinator/trials/run_process.h"

namespace tcs {

namespace {

constexpr int kLookMs = 200;
// A run that somebody killed ends within ten seconds (os/guardian.h).
constexpr int kDyingRunLooks = 75;

double SecondsSince(std::int64_t start_ns) {
  return static_cast<double>(HostClockNs(CLOCK_MONOTONIC) - start_ns) * 1e-9;
}

// The folder is empty afterwards, and no run of before writes into it any more. The sentence, if
// that cannot be had.
std::string MakeAnew(const std::string& folder) {
  for (int look = 0; !FolderLock(folder).IsOurs(); ++look) {
    if (look == kDyingRunLooks) {
      return "an earlier run still writes to " + folder + "; end it";
    }
    poll(nullptr, 0, kLookMs);
  }
  std::error_code error;
  std::filesystem::remove_all(folder, error);
  return error ? folder + " cannot be removed: " + error.message() : MakeFolder(folder);
}

class Runner {
 public:
  Runner(const TrialsPlan& plan, const std::string& folder, std::vector<Trial> todo,
         const std::vector<TrialOutcome>& earlier, const std::vector<std::int64_t>& duration_ns,
         const RunnerOptions& options, const RunnerEvents& events)
      : plan_(plan),
        folder_(folder),
        todo_(std::move(todo)),
        duration_ns_(duration_ns),
        options_(options),
        events_(events),
        cpus_(CpuPlaces()),
        places_(static_cast<std::size_t>(options.at_once), false) {
    progress_.total = static_cast<int>(todo_.size() + earlier.size());
    progress_.done = static_cast<int>(earlier.size());
    progress_.at_once = options.at_once;
    for (const TrialOutcome& outcome : earlier) {
      progress_.finished_seconds.push_back(static_cast<double>(outcome.real_ns) * 1e-9);
    }
    std::reverse(todo_.begin(), todo_.end());  // the next one is the last
  }

  RunnerReport Run();

 private:
  struct Running {
    Trial trial;
    RunProcess process;
    std::size_t place = 0;
    std::int64_t start_ns = 0;
  };

  std::string FolderOf(const Trial& trial) const { return folder_ + "/" + trial.folder; }
  void StartMore();
  std::string Start(const Trial& trial, std::size_t place);
  void Finish(Running* running);
  void End(TrialEnd end, double seconds);
  void Wait();
  void TakeSignal();
  const TrialsProgress& Look();

  const TrialsPlan& plan_;
  const std::string& folder_;
  std::vector<Trial> todo_;
  const std::vector<std::int64_t>& duration_ns_;
  const RunnerOptions& options_;
  const RunnerEvents& events_;
  const std::vector<CpuPlace> cpus_;
  std::vector<bool> places_;  // which are taken
  std::list<Running> running_;
  TrialsProgress progress_;
  RunnerReport report_;
  const std::int64_t start_ns_ = HostClockNs(CLOCK_MONOTONIC);
  UniqueFd signals_;
  StopRequest stop_;
};

RunnerReport Runner::Run() {
  sigset_t stops;
  sigemptyset(&stops);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&stops, signal);
  sigprocmask(SIG_BLOCK, &stops, nullptr);
  signals_.Reset(signalfd(-1, &stops, SFD_CLOEXEC | SFD_NONBLOCK));
  for (;;) {
    if (!report_.interrupted) StartMore();
    if (running_.empty() || stop_.insists()) break;
    if (events_.on_progress && !report_.interrupted) events_.on_progress(Look());
    Wait();
  }
  return std::move(report_);
}

void Runner::StartMore() {
  while (!todo_.empty() && running_.size() < places_.size()) {
    const auto place = static_cast<std::size_t>(std::find(places_.begin(), places_.end(), false) -
                                                places_.begin());
    const Trial trial = todo_.back();
    todo_.pop_back();
    if (const std::string error = Start(trial, place); !error.empty()) End({trial, {}, error}, 0);
  }
}

std::string Runner::Start(const Trial& trial, std::size_t place) {
  const std::string folder = FolderOf(trial);
  if (std::string error = MakeAnew(folder); !error.empty()) return error;
  RunProcessRequest request;
  request.arguments = RunArgumentsOf(plan_, trial);
  request.arguments.insert(request.arguments.end(), {"--out", folder});
  if (!options_.waits_for_cpu) request.arguments.emplace_back("--no-wait");
  request.log = folder + "/tcsim.log";
  request.own_network = options_.own_networks;
  request.cpus = PlaceOfRun(cpus_, options_.whole_cores, options_.at_once, static_cast<int>(place));
  Running running{trial, {}, place, HostClockNs(CLOCK_MONOTONIC)};
  if (const std::string error = RunProcess::Start(request, &running.process); !error.empty()) {
    return "no process can be made: " + error;
  }
  places_[place] = true;
  running_.push_back(std::move(running));
  return {};
}

void Runner::Finish(Running* running) {
  const int status = running->process.Reap();
  places_[running->place] = false;
  const std::string folder = FolderOf(running->trial);
  TrialEnd end{running->trial, ReadOutcome(folder, running->trial.seed), {}};
  if (!end.outcome.has_value()) {
    // It was ended by us, or by the terminal.
    if (report_.interrupted) return;
    end.why = LastWords(ReadText(folder + "/tcsim.log"));
    if (end.why.empty()) {
      end.why = WIFSIGNALED(status) ? fmt::format("died of signal {} ({})", WTERMSIG(status),
                                                  strsignal(WTERMSIG(status)))
                                    : fmt::format("exit status {}", WEXITSTATUS(status));
    }
  }
  End(std::move(end), SecondsSince(running->start_ns));
}

void Runner::End(TrialEnd end, double seconds) {
  if (end.outcome.has_value()) {
    ++progress_.done;
    progress_.finished_seconds.push_back(seconds);
  } else {
    ++progress_.failed;
  }
  report_.ends.push_back(std::move(end));
  if (events_.on_end) events_.on_end(report_.ends.back(), Look());
}

void Runner::Wait() {
  std::vector<pollfd> fds{{signals_.get(), POLLIN, 0}};
  for (const Running& running : running_) fds.push_back({running.process.pidfd(), POLLIN, 0});
  const int happened = poll(fds.data(), fds.size(), events_.on_progress ? kLookMs : -1);
  // First, since ^C at a terminal reaches the runs, too: their ends are no failures then.
  TakeSignal();
  auto running = running_.begin();
  for (std::size_t i = 1; i < fds.size() && happened > 0; ++i) {
    const auto next = std::next(running);
    if (fds[i].revents != 0) {
      Running ended = std::move(*running);
      running_.erase(running);
      Finish(&ended);
    }
    running = next;
  }
}

void Runner::TakeSignal() {
  signalfd_siginfo info;
  while (read(signals_.get(), &info, sizeof info) == sizeof info) {
    const bool is_first = !stop_.asked();
    stop_.Take(static_cast<int>(info.ssi_signo), HostClockNs(CLOCK_MONOTONIC));
    report_.interrupted = true;
    report_.stop_signal = stop_.signal();
    if (!is_first) continue;
    if (events_.on_stopping) events_.on_stopping();
    for (const Running& running : running_) running.process.EndInOrder();
  }
}

const TrialsProgress& Runner::Look() {
  progress_.elapsed_seconds = SecondsSince(start_ns_);
  progress_.running.clear();
  for (const Running& running : running_) {
    const auto whole_ns = static_cast<double>(duration_ns_[running.trial.group]);
    progress_.running.push_back({SecondsSince(running.start_ns),
                                 static_cast<double>(running.process.virtual_ns()) / whole_ns});
  }
  return progress_;
}

}  // namespace

RunnerReport RunTrials(const TrialsPlan& plan, const std::string& folder,
                       const std::vector<Trial>& todo, const std::vector<TrialOutcome>& earlier,
                       const std::vector<std::int64_t>& duration_ns, const RunnerOptions& options,
                       const RunnerEvents& events) {
  return Runner(plan, folder, todo, earlier, duration_ns, options, events).Run();
}

}  // namespace tcs
