#include "coordinator/trials/slurm/array_jobs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <sstream>

namespace tcs {

namespace {

// Columns of fixed widths: in its other form squeue does not tell the exit status.
struct Column {
  const char* name;
  std::size_t width;
};
constexpr std::array<Column, 6> kColumns{{{"ArrayJobID", 20},
                                          {"ArrayTaskID", 20},
                                          {"State", 24},
                                          {"exit_code", 16},
                                          {"NodeList", 128},
                                          {"Reason", 128}}};

std::string Trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

// For sh.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted + "'";
}

// "68:0": an exit status and a signal; before Slurm 23 as of waitpid: "17408".
int ParseExit(const std::string& text) {
  const std::size_t colon = text.find(':');
  const int first = std::atoi(text.c_str());
  if (colon == std::string::npos) return first;
  return W_EXITCODE(first, std::atoi(text.c_str() + colon + 1));
}

bool IsOneOf(const std::string& word, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* w) { return word == w; });
}

}  // namespace

bool QueuedJob::IsPending() const {
  return IsOneOf(state, {"PENDING", "CONFIGURING", "REQUEUED", "REQUEUE_HOLD", "REQUEUE_FED",
                         "RESV_DEL_HOLD", "SPECIAL_EXIT"});
}

bool QueuedJob::IsAlive() const {
  return IsPending() || IsOneOf(state, {"RUNNING", "COMPLETING", "SUSPENDED", "STOPPED", "RESIZING",
                                        "SIGNALING", "STAGE_OUT"});
}

std::vector<std::string> SubmitWords(const SubmitRequest& request) {
  std::vector<std::string> words{"sbatch", "--parsable", "--job-name=" + request.name,
                                 fmt::format("--array=0-{}", request.jobs - 1),
                                 "--output=/dev/null",
                                 // tcsim itself names what is lost, and asks for it again.
                                 "--no-requeue", "--ntasks=1",
                                 // The caller's own folder is not always there on a node; the job
                                 // changes to its folder itself.
                                 "--chdir=/"};
  if (request.whole_cores) words.emplace_back("--hint=nomultithread");
  if (!request.excluded_nodes.empty()) {
    words.push_back(fmt::format("--exclude={}", fmt::join(request.excluded_nodes, ",")));
  }
  words.insert(words.end(), request.options.begin(), request.options.end());
  words.push_back(
      fmt::format("--wrap=exec {} slurm-job {}", Quoted(request.tcsim), Quoted(request.folder)));
  return words;
}

std::string WhyNotForSbatch(const std::string& option) {
  const std::string name = option.substr(0, option.find('='));
  if (option.rfind("--", 0) != 0 || option.size() == 2) {
    return fmt::format(
        "--slurm-option: '{}' is not an option of sbatch; write it like "
        "--slurm-option=--partition=short",
        option);
  }
  if (IsOneOf(name, {"--array", "--wrap", "--parsable", "--job-name", "--test-only", "--wait",
                     "--chdir", "--ntasks", "--nodes"})) {
    return fmt::format("--slurm-option: {} is set by tcsim; leave it out{}", name,
                       name == "--array" ? ", and use --jobs for the number of jobs" : "");
  }
  return {};
}

std::vector<std::string> QueueWords(const std::string& name, unsigned user) {
  std::string columns;
  for (const Column& column : kColumns) {
    columns += fmt::format("{}{}:{}", columns.empty() ? "" : ",", column.name, column.width);
  }
  return {"squeue",
          "--noheader",
          "--array",
          "--states=all",
          fmt::format("--user={}", user),
          "--name=" + name,
          "--Format=" + columns};
}

std::vector<std::string> CancelWords(const std::string& name, unsigned user) {
  return {"scancel", fmt::format("--user={}", user), "--name=" + name};
}

std::map<std::string, QueuedJob> ParseQueue(const std::string& text) {
  std::map<std::string, QueuedJob> jobs;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::array<std::string, kColumns.size()> fields;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < kColumns.size(); begin += kColumns[i++].width) {
      if (begin < line.size()) fields[i] = Trimmed(line.substr(begin, kColumns[i].width));
    }
    if (fields[2].empty()) continue;
    QueuedJob job;
    job.id = fields[0] + "_" + fields[1];
    job.state = fields[2];
    job.wait_status = ParseExit(fields[3]);
    if (fields[4] != "(null)") job.node = fields[4];
    if (!IsOneOf(fields[5], {"None", "(null)"})) job.reason = fields[5];
    jobs[job.id] = job;
  }
  return jobs;
}

int LargestArray(const std::string& configuration) {
  constexpr int kDefault = 1001;
  std::istringstream lines(configuration);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name, equals;
    int value = 0;
    if (words >> name >> equals >> value && name == "MaxArraySize" && value > 0) return value;
  }
  return kDefault;
}

std::string WhyGone(const QueuedJob* job) {
  if (job == nullptr) return "its job is not in the queue any more";
  const int status = job->wait_status;
  const std::string& state = job->state;
  if (state == "NODE_FAIL") return "NODE_FAIL: the node failed";
  if (state == "OUT_OF_MEMORY") {
    return "OUT_OF_MEMORY: the job needed more memory than it had; see --slurm-option=--mem=SIZE";
  }
  if (state == "TIMEOUT") {
    return "TIMEOUT: the job's time was up; see --slurm-option=--time=MINUTES";
  }
  if (state == "CANCELLED") return "CANCELLED: somebody has cancelled its job";
  if (WIFEXITED(status) && WEXITSTATUS(status) == kRunWasKilled) {
    return fmt::format("{}: its run was killed", state);
  }
  if (WIFSIGNALED(status)) return fmt::format("{}: signal {}", state, WTERMSIG(status));
  if (WEXITSTATUS(status) != 0) {
    return fmt::format("{}: exit status {}", state, WEXITSTATUS(status));
  }
  return job->reason.empty() ? state : fmt::format("{}: {}", state, job->reason);
}

}  // namespace tcs
