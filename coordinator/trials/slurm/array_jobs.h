// Array jobs of Slurm: how they are asked for, and what the queue says of them. Pure.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace tcs {

// A job of an array.
struct QueuedJob {
  std::string id;            // "12_3"
  std::string state;         // as Slurm names it: "RUNNING", "NODE_FAIL"
  std::string node, reason;  // empty: none
  int wait_status = 0;       // as of waitpid

  bool IsPending() const;
  // True while the job has not ended.
  bool IsAlive() const;
};

// The exit statuses of a call's jobs, besides 0.
inline constexpr int kFolderNotShared = 66;  // the job does not see the folder of its work
inline constexpr int kJobCannotRun = 67;     // the job has left the reason in its work folder
inline constexpr int kRunWasKilled = 68;     // a run was killed, as by the kernel if memory ran out

struct SubmitRequest {
  std::string name;    // of the jobs
  std::string tcsim;   // the program's path
  std::string folder;  // the folder of the work
  int jobs = 1;
  bool whole_cores = false;
  std::vector<std::string> excluded_nodes;
  std::vector<std::string> options;  // of the user's, for sbatch
};
std::vector<std::string> SubmitWords(const SubmitRequest& request);

// Why the user cannot give this option to sbatch; empty if they can.
std::string WhyNotForSbatch(const std::string& option);

// `user`: a number.
std::vector<std::string> QueueWords(const std::string& name, unsigned user);
std::vector<std::string> CancelWords(const std::string& name, unsigned user);

// The jobs in the output of the command of QueueWords, by id.
std::map<std::string, QueuedJob> ParseQueue(const std::string& text);

// How large an array may be, from `scontrol show config`; Slurm's own default if that does not say.
int LargestArray(const std::string& configuration);

// Why a job has ended without a result, as "NODE_FAIL: the node failed". `job`: null if the queue
// does not know it any more.
std::string WhyGone(const QueuedJob* job);

}  // namespace tcs
