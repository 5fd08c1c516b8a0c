#include "coordinator/trials/local_launcher.h"

#include <fmt/format.h>
#include <poll.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>

#include <algorithm>
#include <list>
#include <utility>

#include "coordinator/os/cpu_places.h"
#include "coordinator/port/clocks.h"
#include "coordinator/trials/run_process.h"
#include "coordinator/trials/stop_signals.h"
#include "coordinator/trials/trial_folder.h"

namespace tcs {

namespace {

constexpr int kLookMs = 200;

double SecondsSince(std::int64_t start_ns) {
  return static_cast<double>(HostClockNs(CLOCK_MONOTONIC) - start_ns) * 1e-9;
}

class Runner {
 public:
  Runner(const TrialsWork& work, const LocalOptions& options, const LauncherEvents& events)
      : work_(work),
        todo_(work.todo),
        options_(options),
        events_(events),
        cpus_(CpuPlaces()),
        places_(static_cast<std::size_t>(options.at_once), false) {
    progress_.total = static_cast<int>(todo_.size() + work.earlier.size());
    progress_.done = static_cast<int>(work.earlier.size());
    progress_.at_once = options.at_once;
    for (const TrialOutcome& outcome : work.earlier) {
      progress_.finished_seconds.push_back(static_cast<double>(outcome.real_ns) * 1e-9);
    }
    std::reverse(todo_.begin(), todo_.end());  // the next trial is at the end
  }

  LauncherReport Run();

 private:
  struct Running {
    Trial trial;
    RunProcess process;
    std::size_t place = 0;
    std::int64_t start_ns = 0;
  };

  std::string FolderOf(const Trial& trial) const { return work_.folder + "/" + trial.folder; }
  void StartMore();
  std::string Start(const Trial& trial, std::size_t place);
  void Finish(Running* running);
  void End(TrialEnd end, double seconds);
  void Wait();
  void TakeSignal();
  const TrialsProgress& Look();

  const TrialsWork& work_;
  std::vector<Trial> todo_;
  const LocalOptions& options_;
  const LauncherEvents& events_;
  const std::vector<CpuPlace> cpus_;
  std::vector<bool> places_;  // which are taken
  std::list<Running> running_;
  TrialsProgress progress_;
  LauncherReport report_;
  const std::int64_t start_ns_ = HostClockNs(CLOCK_MONOTONIC);
  StopSignals stop_;
};

LauncherReport Runner::Run() {
  for (;;) {
    if (!report_.interrupted) StartMore();
    if (running_.empty() || stop_.request().insists()) break;
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
  if (std::string error = MakeTrialFolderAnew(folder); !error.empty()) return error;
  RunProcessRequest request;
  request.arguments = RunArgumentsOf(work_.plan, trial);
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
    // The trial was ended by the launcher, or by the terminal.
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
  std::vector<pollfd> fds{{stop_.fd(), POLLIN, 0}};
  for (const Running& running : running_) fds.push_back({running.process.pidfd(), POLLIN, 0});
  const int happened = poll(fds.data(), fds.size(), events_.on_progress ? kLookMs : -1);
  // The signal is taken first, since ^C at a terminal reaches the runs, too: their ends are no
  // failures then.
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
  const bool is_first = stop_.Take();
  report_.interrupted = stop_.request().asked();
  report_.stop_signal = stop_.request().signal();
  if (!is_first) return;
  if (events_.on_stopping) events_.on_stopping();
  for (const Running& running : running_) running.process.EndInOrder();
}

const TrialsProgress& Runner::Look() {
  progress_.elapsed_seconds = SecondsSince(start_ns_);
  progress_.running.clear();
  for (const Running& running : running_) {
    const auto whole_ns = static_cast<double>(work_.duration_ns[running.trial.group]);
    progress_.running.push_back({SecondsSince(running.start_ns),
                                 static_cast<double>(running.process.virtual_ns()) / whole_ns});
  }
  return progress_;
}

}  // namespace

LauncherReport LocalLauncher::Run(const TrialsWork& work, const LauncherEvents& events) {
  return Runner(work, options_, events).Run();
}

}  // namespace tcs
