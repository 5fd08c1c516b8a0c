#include "coordinator/trials/slurm/slurm_launcher.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "coordinator/os/files.h"
#include "coordinator/port/clocks.h"
#include "coordinator/trials/slurm/array_jobs.h"
#include "coordinator/trials/slurm/commands.h"
#include "coordinator/trials/slurm/environment.h"
#include "coordinator/trials/slurm_folder.h"
#include "coordinator/trials/stop_signals.h"
#include "coordinator/trials/trial_folder.h"

namespace tcs {

namespace {

namespace fs = std::filesystem;

// A trial is run so often, if its jobs are lost.
constexpr int kMostTimes = 3;
// So many times jobs are asked for of which none begins a trial.
constexpr int kMostVainCalls = 3;
// In all, whatever arrays may hold: more do not make the controller faster.
constexpr int kMostJobs = 1000;
// Between two looks: a second, and later a thirtieth of the time that has passed, up to ten
// seconds.
constexpr std::int64_t kLeastLookNs = 1'000'000'000, kMostLookNs = 10'000'000'000;
// A file that a job has written before its end may reach another machine later than the news of
// that end.
constexpr std::int64_t kFilesAreLateNs = 20'000'000'000;
// After so long without a running trial a user wants to know why nothing happens.
constexpr std::int64_t kIdleNs = 60'000'000'000;
// The jobs are told to end, and Slurm takes a moment; the caller is killed after 15 s.
constexpr std::int64_t kEndWithinNs = 10'000'000'000;

std::int64_t Now() { return HostClockNs(CLOCK_MONOTONIC); }

class Sweep {
 public:
  Sweep(const TrialsWork& work, const SlurmOptions& options, const LauncherEvents& events)
      : work_(work),
        options_(options),
        events_(events),
        results_(AbsolutePathOf(work.folder)),
        name_(NewWorkName()),
        folder_(WorkFolderIn(results_, name_)),
        trials_(work.todo.size()) {
    progress_.total = static_cast<int>(work.todo.size() + work.earlier.size());
    progress_.done = static_cast<int>(work.earlier.size());
    for (const TrialOutcome& outcome : work.earlier) {
      progress_.finished_seconds.push_back(static_cast<double>(outcome.real_ns) * 1e-9);
    }
    for (std::size_t i = 0; i < work.todo.size(); ++i) index_of_[work.todo[i].folder] = i;
  }

  LauncherReport Run();

 private:
  struct State {
    bool has_ended = false;
    int lost = 0;
    std::int64_t running_since_ns = 0;  // 0: the trial does not run
    std::int64_t gone_since_ns = 0;     // since when its job is gone, without a result seen
  };

  std::string Prepare();
  void Submit();
  bool LookAtQueue();
  void LookForResults();
  void LookAtClaims(bool queue_is_known);
  void SayWhyNothingRuns();
  void LookForBadNodes();
  void Lose(std::size_t index, const Claim& claim, const std::string& why);
  void End(std::size_t index, std::optional<TrialOutcome> outcome, const std::string& why);
  void TakeSignal();
  void Finish();
  void Notice(const std::string& sentence) const {
    if (events_.on_notice) events_.on_notice(sentence);
  }
  int Unended() const { return static_cast<int>(trials_.size()) - ended_; }
  int Alive() const;
  const QueuedJob* Find(const std::string& job) const;
  void Wait();

  const TrialsWork& work_;
  const SlurmOptions& options_;
  const LauncherEvents& events_;
  const std::string results_, name_;
  const SlurmWorkFolder folder_;
  const unsigned user_ = geteuid();

  std::vector<State> trials_;
  std::map<std::string, std::size_t> index_of_;  // by folder
  int ended_ = 0, claimed_ = 0;
  std::map<std::string, QueuedJob> queue_;
  std::int64_t queue_unknown_since_ns_ = 0;
  std::int64_t idle_since_ns_ = 0;  // since when no trial runs
  bool said_unknown_ = false, said_idle_ = false;
  std::vector<std::string> bad_nodes_;
  std::string bad_news_;  // about the first of these nodes
  // How the last job that ran nothing has ended.
  std::string last_gone_ = "the queue does not know it any more";
  std::set<std::string> seen_gone_;
  int most_jobs_ = 0;
  int vain_calls_ = 0;
  bool has_asked_ = false;  // jobs were asked for
  bool has_begun_ = true;   // a trial has begun since jobs were asked for
  TrialsProgress progress_;
  LauncherReport report_;
  const std::int64_t start_ns_ = Now();
  StopSignals stop_;
};

LauncherReport Sweep::Run() {
  report_.error = Prepare();
  while (report_.error.empty() && Unended() > 0 && !report_.interrupted) {
    Submit();
    if (!report_.error.empty()) break;
    Wait();
    if (report_.interrupted) break;
    // In this order: a job that has ended by now has left its results before.
    const bool queue_is_known = LookAtQueue();
    LookForResults();
    LookAtClaims(queue_is_known);
    if (queue_is_known) LookForBadNodes();
  }
  Finish();
  return std::move(report_);
}

std::string Sweep::Prepare() {
  SlurmWork asked;
  asked.version = options_.version;
  std::error_code error;
  asked.directory = fs::current_path(error);
  asked.results = results_;
  asked.environment = ReadEnvironment();
  asked.in_host_network = options_.in_host_network;
  for (const Trial& trial : work_.todo) {
    const std::string shown = work_.folder + "/" + trial.folder;
    if (std::string why = RemoveTrialFolder(shown); !why.empty()) return why;
    asked.trials.push_back({trial.seed, trial.folder, shown, RunArgumentsOf(work_.plan, trial)});
  }
  const CommandResult configuration = RunSlurmCommand({"scontrol", "show", "config"});
  most_jobs_ = std::min(kMostJobs, LargestArray(configuration.out));
  if (options_.most_jobs > 0) most_jobs_ = std::min(most_jobs_, options_.most_jobs);
  return folder_.Make(asked);
}

int Sweep::Alive() const {
  return static_cast<int>(std::count_if(queue_.begin(), queue_.end(),
                                        [](const auto& job) { return job.second.IsAlive(); }));
}

const QueuedJob* Sweep::Find(const std::string& job) const {
  const auto found = queue_.find(job);
  return found == queue_.end() ? nullptr : &found->second;
}

// Asks for as many jobs as there are trials without one, less the jobs that are there already.
void Sweep::Submit() {
  if (queue_unknown_since_ns_ != 0) return;
  const int wanted = std::min(most_jobs_, Unended()), alive = Alive();
  if (alive >= wanted || Unended() <= claimed_) return;
  vain_calls_ = std::exchange(has_begun_, false) ? 0 : vain_calls_ + 1;
  if (vain_calls_ >= kMostVainCalls) {
    report_.error = !bad_news_.empty()
                        ? bad_news_
                        : fmt::format(
                              "Slurm was asked for jobs {} times, and no trial has begun; "
                              "the last one ended so: {}",
                              kMostVainCalls, last_gone_);
    return;
  }
  SubmitRequest request;
  request.name = name_;
  request.tcsim = options_.tcsim;
  request.folder = folder_.path();
  request.jobs = wanted - alive;
  request.whole_cores = options_.whole_cores;
  request.excluded_nodes = bad_nodes_;
  request.options = options_.options;
  has_asked_ = true;
  const CommandResult result = RunSlurmCommand(SubmitWords(request));
  TakeSignal();
  if (report_.interrupted) return;
  if (result.succeeded) {
    // These entries stand in until the queue is asked.
    const std::string array = result.out.substr(0, result.out.find_first_of(";\n"));
    for (int i = 0; i < request.jobs; ++i) {
      QueuedJob job;
      job.id = fmt::format("{}_{}", array, i);
      job.state = "PENDING";
      queue_[job.id] = job;
    }
    return;
  }
  const std::string reason = SlurmsReason(result.said);
  if (alive > 0) {
    most_jobs_ = alive;
    Notice(fmt::format("Slurm takes no more than {} jobs (\"{}\"); going on with those", alive,
                       reason));
    return;
  }
  report_.error = !bad_news_.empty()
                      ? bad_news_
                      : fmt::format(
                            "Slurm does not take the jobs: \"{}\"; --slurm-option gives "
                            "options to sbatch, such as --slurm-option=--partition=NAME, "
                            "and --jobs asks for fewer",
                            reason);
}

// False if squeue does not answer: queue_ stays as it was seen last.
bool Sweep::LookAtQueue() {
  const CommandResult result = RunSlurmCommand(QueueWords(name_, user_));
  if (result.succeeded) {
    queue_ = ParseQueue(result.out);
    if (said_unknown_) Notice("squeue answers again");
    queue_unknown_since_ns_ = 0;
    said_unknown_ = false;
    return true;
  }
  if (queue_unknown_since_ns_ == 0) queue_unknown_since_ns_ = Now();
  if (!said_unknown_ && Now() - queue_unknown_since_ns_ > kLeastLookNs * 30) {
    said_unknown_ = true;
    Notice(fmt::format("squeue does not say how the jobs are (\"{}\"); waiting for it",
                       SlurmsReason(result.said)));
  }
  return false;
}

void Sweep::LookForResults() {
  std::set<std::string> folders;
  for (const Trial& trial : work_.todo) {
    folders.insert(fs::path(trial.folder).parent_path().string());
  }
  for (const std::string& folder : folders) {
    const fs::path path = folder.empty() ? fs::path(results_) : fs::path(results_) / folder;
    std::error_code error;
    for (fs::directory_iterator entry(path, error); !error && entry != fs::directory_iterator{};
         entry.increment(error)) {
      const std::string name = entry->path().filename();
      const auto found = index_of_.find(folder.empty() ? name : folder + "/" + name);
      if (found == index_of_.end() || trials_[found->second].has_ended) continue;
      const Trial& trial = work_.todo[found->second];
      const auto outcome = ReadOutcome(entry->path(), trial.seed);
      End(found->second, outcome,
          outcome.has_value() ? "" : LastWords(ReadText(entry->path() / "tcsim.log")));
    }
  }
}

void Sweep::LookAtClaims(bool queue_is_known) {
  const std::int64_t now_ns = Now();
  claimed_ = 0;
  progress_.running.clear();
  for (const auto& [index, claim] : folder_.Claims()) {
    if (index >= trials_.size()) continue;
    State& state = trials_[index];
    has_begun_ = true;
    if (state.has_ended) continue;
    const QueuedJob* job = Find(claim.job);
    const bool is_gone = job == nullptr || !job->IsAlive();
    if (!is_gone || !queue_is_known) {
      ++claimed_;
      state.gone_since_ns = 0;
      if (state.running_since_ns == 0) state.running_since_ns = now_ns;
      const auto whole_ns = static_cast<double>(work_.duration_ns[work_.todo[index].group]);
      progress_.running.push_back({static_cast<double>(now_ns - state.running_since_ns) * 1e-9,
                                   static_cast<double>(folder_.Progress(index)) / whole_ns});
      continue;
    }
    if (state.gone_since_ns == 0) state.gone_since_ns = now_ns;
    const bool ended_well = job != nullptr && job->state == "COMPLETED";
    if (ended_well && now_ns - state.gone_since_ns < kFilesAreLateNs) {
      ++claimed_;
      continue;
    }
    const std::string error = folder_.Error(claim.job);
    Lose(index, claim, error.empty() ? WhyGone(job) : error);
  }
  SayWhyNothingRuns();
  progress_.at_once = std::max(1, static_cast<int>(progress_.running.size()));
  progress_.queued = static_cast<int>(std::count_if(
      queue_.begin(), queue_.end(), [](const auto& j) { return j.second.IsPending(); }));
}

void Sweep::SayWhyNothingRuns() {
  if (!progress_.running.empty()) {
    idle_since_ns_ = 0;
    return;
  }
  if (idle_since_ns_ == 0) idle_since_ns_ = Now();
  if (said_idle_ || Now() - idle_since_ns_ < kIdleNs) return;
  for (const auto& [id, job] : queue_) {
    if (!job.IsPending() || job.reason.empty()) continue;
    said_idle_ = true;
    Notice(fmt::format("no trial runs: Slurm's reason to let the jobs wait is \"{}\"", job.reason));
    return;
  }
}

void Sweep::Lose(std::size_t index, const Claim& claim, const std::string& why) {
  State& state = trials_[index];
  state.running_since_ns = state.gone_since_ns = 0;
  const bool again = ++state.lost < kMostTimes;
  if (again) {
    if (events_.on_loss) {
      events_.on_loss({work_.todo[index], claim.node, why, state.lost, again});
    }
    folder_.Release(index);
    return;
  }
  End(index, {},
      fmt::format("its job was lost {} times, at last on node {} ({})", kMostTimes, claim.node,
                  why));
}

// Finds nodes on which jobs end before they have run anything. Such a node gets no more jobs.
void Sweep::LookForBadNodes() {
  for (const auto& [id, job] : queue_) {
    if (job.IsAlive() || job.state == "COMPLETED" || !seen_gone_.insert(id).second) continue;
    last_gone_ = fmt::format("job {} on node {}: {}", id, job.node, WhyGone(&job));
    const int exit_status = WIFEXITED(job.wait_status) ? WEXITSTATUS(job.wait_status) : 0;
    std::string why;
    if (exit_status == kFolderNotShared) {
      why = fmt::format(
          "node {} does not see the folder {}; choose one with --out that this machine "
          "and all nodes share",
          job.node, results_);
    } else if (exit_status == 126 || exit_status == 127) {
      why = fmt::format("node {} cannot start {}; install tcs at the same path on all nodes",
                        job.node, options_.tcsim);
    } else if (exit_status == kJobCannotRun) {
      why = folder_.Error(id);
    }
    const bool is_known =
        std::find(bad_nodes_.begin(), bad_nodes_.end(), job.node) != bad_nodes_.end();
    if (why.empty() || job.node.empty() || is_known) continue;
    bad_nodes_.push_back(job.node);
    if (bad_news_.empty()) bad_news_ = why;
    Notice(why + "; it gets no more jobs");
  }
}

void Sweep::End(std::size_t index, std::optional<TrialOutcome> outcome, const std::string& why) {
  trials_[index].has_ended = true;
  ++ended_;
  has_begun_ = true;
  if (outcome.has_value()) {
    ++progress_.done;
    progress_.finished_seconds.push_back(static_cast<double>(outcome->real_ns) * 1e-9);
  } else {
    ++progress_.failed;
  }
  progress_.elapsed_seconds = static_cast<double>(Now() - start_ns_) * 1e-9;
  report_.ends.push_back({work_.todo[index], outcome, why});
  if (events_.on_end) events_.on_end(report_.ends.back(), progress_);
}

void Sweep::TakeSignal() {
  const bool is_first = stop_.Take();
  report_.interrupted = stop_.request().asked();
  report_.stop_signal = stop_.request().signal();
  if (is_first && events_.on_stopping) events_.on_stopping();
}

void Sweep::Wait() {
  const std::int64_t now_ns = Now();
  const std::int64_t until_ns =
      now_ns + std::clamp((now_ns - start_ns_) / 30, kLeastLookNs, kMostLookNs);
  do {
    progress_.elapsed_seconds = static_cast<double>(Now() - start_ns_) * 1e-9;
    if (events_.on_progress) events_.on_progress(progress_);
    pollfd fd{stop_.fd(), POLLIN, 0};
    poll(&fd, 1, 250);
    TakeSignal();
  } while (Now() < until_ns && !report_.interrupted);
}

// Nothing of the sweep is left in the queue, and nothing that comes late changes the results.
void Sweep::Finish() {
  if (has_asked_ && (!LookAtQueue() || Alive() > 0 || report_.interrupted)) {
    const std::string error = CancelJobs({name_});
    if (!error.empty()) Notice(error);
    const std::int64_t until_ns = Now() + kEndWithinNs;
    while (report_.interrupted && LookAtQueue() && Alive() > 0 && Now() < until_ns &&
           !stop_.request().insists()) {
      pollfd fd{stop_.fd(), POLLIN, 0};
      poll(&fd, 1, 250);
      TakeSignal();
    }
  }
  if (report_.interrupted) LookForResults();
  static_cast<void>(RetireWorkFolders(results_));
}

}  // namespace

std::string WhyNoSlurm() {
  for (const char* command : {"sbatch", "squeue", "scancel", "scontrol"}) {
    if (RunSlurmCommand({command, "--version"}).is_found) continue;
    return fmt::format(
        "--launcher slurm: there is no {} in PATH; call tcsim on a machine of the cluster that has "
        "Slurm's commands (on Debian: apt install slurm-client)",
        command);
  }
  return {};
}

std::string CancelJobs(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const CommandResult result = RunSlurmCommand(CancelWords(name, geteuid()));
    if (result.succeeded) continue;
    return fmt::format(
        "the jobs {} may still be in Slurm's queue, without effect on the results "
        "(scancel: \"{}\"); end them with `scancel --name={}`",
        name, result.is_found ? SlurmsReason(result.said) : "not in PATH", name);
  }
  return {};
}

LauncherReport SlurmLauncher::Run(const TrialsWork& work, const LauncherEvents& events) {
  return Sweep(work, options_, events).Run();
}

}  // namespace tcs
