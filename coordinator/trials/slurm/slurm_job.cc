#include "coordinator/trials/slurm/slurm_job.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/cpu_places.h"
#include "coordinator/os/files.h"
#include "coordinator/os/own_network.h"
#include "coordinator/port/clocks.h"
#include "coordinator/trials/outcome.h"
#include "coordinator/trials/run_process.h"
#include "coordinator/trials/slurm/array_jobs.h"
#include "coordinator/trials/slurm/environment.h"
#include "coordinator/trials/slurm_folder.h"
#include "coordinator/trials/stop_signals.h"

namespace tcs {

namespace {

constexpr std::int64_t kTakesTrialsForNs = 300'000'000'000;
constexpr int kStopped = 128 + SIGTERM;  // as a shell says it
constexpr int kTellsEveryMs = 2000;
constexpr int kSlurmLookMs = 200;
// The signal that ends a job goes to all processes of the job, and the run's clients may be the
// first.
constexpr int kSignalIsLateByMs = 1000;

std::string FromEnvironment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

// The run claims one of the CPUs that Slurm has bound the job to. Where Slurm binds no jobs, those
// are all CPUs of the node, and as many jobs as there are CPUs share them. A run that may use
// several CPUs leaves the first one to the rest of the machine (os/cpu_claim.h): so a job that
// finds only that one free is to use it, and every other job takes whichever becomes free.
cpu_set_t CpusForRun() {
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  const std::vector<CpuPlace> places = CpuPlaces();
  bool others_are_claimed = true;
  for (const CpuPlace& place : places) {
    CPU_SET(static_cast<std::size_t>(place.number), &cpus);
    if (place.number != places.front().number && !IsClaimed(place.number)) {
      others_are_claimed = false;
    }
  }
  if (!others_are_claimed || IsClaimed(places.front().number)) return cpus;
  CPU_ZERO(&cpus);
  CPU_SET(static_cast<std::size_t>(places.front().number), &cpus);
  return cpus;
}

// The log names the folder that the run wrote to; it is to name the folder that this one becomes.
void RenameInLog(const std::string& log, const std::string& from, const std::string& to) {
  std::string text = ReadText(log);
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  static_cast<void>(WriteWhole(log, text, Withstands::kCrash));
}

class SlurmJob {
 public:
  SlurmJob(const std::string& folder, SlurmWork work, Claim self, std::size_t first)
      : folder_(folder), work_(std::move(work)), self_(std::move(self)), first_(first) {}

  int Run(const std::string& version);

 private:
  std::optional<std::size_t> ClaimNext();
  // 0, or the job's exit status.
  int RunTrial(std::size_t index);
  int EndTrial(std::size_t index, const std::string& run, int status);
  bool IsStopped(int wait_ms);
  int Fail(const std::string& sentence) const;

  const SlurmWorkFolder folder_;
  const SlurmWork work_;
  const Claim self_;
  const std::size_t first_;  // where the job begins to look for a trial
  bool own_network_ = false;
  StopSignals stop_;
};

int SlurmJob::Fail(const std::string& sentence) const {
  folder_.SetError(self_.job, sentence);
  fprintf(stderr, "tcsim: %s\n", sentence.c_str());
  return kJobCannotRun;
}

bool SlurmJob::IsStopped(int wait_ms) {
  pollfd fd{stop_.fd(), POLLIN, 0};
  poll(&fd, 1, wait_ms);
  stop_.Take();
  return stop_.request().asked();
}

std::optional<std::size_t> SlurmJob::ClaimNext() {
  const std::size_t count = work_.trials.size();
  // Jobs that begin at once begin at different places, and do not dispute the first trials.
  if (folder_.TryToClaim(first_ % count, self_)) return first_ % count;
  const std::vector<bool> claimed = folder_.Claimed(count);
  for (std::size_t i = 1; i <= count; ++i) {
    const std::size_t trial = (first_ + i) % count;
    if (!claimed[trial] && folder_.TryToClaim(trial, self_)) return trial;
  }
  return {};
}

int SlurmJob::Run(const std::string& version) {
  if (version != work_.version) {
    return Fail(
        fmt::format("node {} has tcsim {}, and the trials were called with {}; install the "
                    "same one on all nodes",
                    self_.node, version, work_.version));
  }
  if (chdir(work_.directory.c_str()) != 0) {
    return Fail(
        fmt::format("node {} has no folder {} ({}), where the trials were called from; "
                    "call them from a folder that all nodes have",
                    self_.node, work_.directory, strerror(errno)));
  }
  TakeEnvironment(work_.environment);
  own_network_ = !work_.in_host_network && WhyNoOwnNetwork().empty();
  const std::int64_t start_ns = HostClockNs(CLOCK_MONOTONIC);
  while (HostClockNs(CLOCK_MONOTONIC) - start_ns < kTakesTrialsForNs) {
    const std::optional<std::size_t> trial = ClaimNext();
    if (!trial.has_value()) return 0;
    if (const int status = RunTrial(*trial); status != 0) return status;
    if (IsStopped(0)) return kStopped;
  }
  return 0;
}

int SlurmJob::RunTrial(std::size_t index) {
  const std::string run = folder_.RunFolder(index, self_.job);
  if (const std::string error = MakeFolder(run); !error.empty()) {
    return Fail(fmt::format("on node {}: {}", self_.node, error));
  }
  // Trials with the same fixed ports come one after the other in the machine's own network.
  FolderLock network;
  while (!own_network_ && !(network = FolderLock("/sys/class/net/lo")).IsOurs()) {
    if (IsStopped(kSlurmLookMs)) return kStopped;
  }
  RunProcessRequest request;
  request.arguments = work_.trials[index].arguments;
  request.arguments.insert(request.arguments.end(), {"--out", run});
  request.log = run + "/tcsim.log";
  request.own_network = own_network_;
  request.cpus = CpusForRun();
  RunProcess process;
  if (const std::string error = RunProcess::Start(request, &process); !error.empty()) {
    return Fail(fmt::format("on node {} no process can be made: {}", self_.node, error));
  }
  for (bool ended = false; !ended;) {
    pollfd fds[]{{process.pidfd(), POLLIN, 0}, {stop_.fd(), POLLIN, 0}};
    const bool is_stopping = stop_.request().asked();
    const int happened = poll(fds, is_stopping ? 1 : 2, kTellsEveryMs);
    ended = happened > 0 && fds[0].revents != 0;
    if (stop_.Take()) process.EndInOrder();
    if (happened == 0) folder_.SetProgress(index, process.virtual_ns());
  }
  return EndTrial(index, run, process.Reap());
}

int SlurmJob::EndTrial(std::size_t index, const std::string& run, int status) {
  const SlurmTrial& trial = work_.trials[index];
  const std::string log = run + "/tcsim.log";
  if (!ReadOutcome(run, trial.seed).has_value()) {
    if (IsStopped(kSignalIsLateByMs)) return kStopped;
    // Memory ran out, or somebody has killed the run: the signal says nothing about the trial.
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) return kRunWasKilled;
    if (LastWords(ReadText(log)).empty()) {
      const std::string how = WIFSIGNALED(status)
                                  ? fmt::format("died of signal {}", WTERMSIG(status))
                                  : fmt::format("exit status {}", WEXITSTATUS(status));
      static_cast<void>(WriteWhole(log, ReadText(log) + "tcsim: " + how + "\n"));
    }
  }
  RenameInLog(log, run, trial.shown_folder);
  static_cast<void>(
      WriteWhole(run + "/job.json",
                 fmt::format("{{\"job\": \"{}\", \"node\": \"{}\"}}\n", self_.job, self_.node),
                 Withstands::kCrash));
  const std::string error = PublishRun(run, work_.results + "/" + trial.folder);
  return error.empty() ? 0 : Fail(fmt::format("on node {}: {}", self_.node, error));
}

}  // namespace

int RunSlurmJob(const std::string& folder, const std::string& version) {
  const std::string array = FromEnvironment("SLURM_ARRAY_JOB_ID"),
                    task = FromEnvironment("SLURM_ARRAY_TASK_ID"),
                    node = FromEnvironment("SLURMD_NODENAME");
  const SlurmWorkFolder work_folder(folder);
  std::optional<SlurmWork> work = work_folder.Read();
  if (!work.has_value() || work->trials.empty()) {
    fprintf(stderr, "tcsim: there is no work for a job of Slurm in %s\n", folder.c_str());
    return kFolderNotShared;
  }
  SlurmJob job(folder, std::move(*work), {array + "_" + task, node},
               std::strtoul(task.c_str(), nullptr, 10));
  return job.Run(version);
}

}  // namespace tcs
