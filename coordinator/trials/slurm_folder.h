// The folder through which the caller of `tcsim trials --launcher slurm` and its jobs speak with
// each other. This folder is on the file system that the cluster's nodes share, in the folder of
// the results:
//
//   DIR/slurm/NAME/work.json     what is to be run; written before the first job
//   DIR/slurm/NAME/claims/7      symbolic link to "12_3@n2": that job, on that node, runs trial 7
//   DIR/slurm/NAME/progress/7    how far the trial is, in ns of virtual time
//   DIR/slurm/NAME/runs/7.12_3/  what the run wrote; renamed to DIR/seed-0008 at the trial's end
//   DIR/slurm/NAME/errors/12_3   why the job can run nothing
//
// A trial has one result, even if several jobs have run the trial: links and renames are made whole
// or not at all on every file system that clusters share. NAME differs for each call, and is the
// name of its jobs. Once the folder is retired nothing can be renamed out of it any more.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tcs {

struct SlurmTrial {
  std::uint64_t seed = 0;
  std::string folder;                  // of its result, beneath `results`
  std::string shown_folder;            // the same, as the user named it
  std::vector<std::string> arguments;  // of tcsim, without --out
};

// A variable of the caller's environment. Slurm hands the variables on; the value is here only if
// Slurm, or the shell that it starts a job with, puts another value in its place: many a secret is
// in the other variables.
struct SlurmVariable {
  std::string name;
  std::optional<std::string> value;
};

struct SlurmWork {
  std::string version;           // of the tcsim that asks for the work
  std::string directory;         // where relative paths begin
  std::string results;           // absolute
  bool in_host_network = false;  // no trial can have a network of its own
  std::vector<SlurmVariable> environment;
  std::vector<SlurmTrial> trials;
};

std::string ToJson(const SlurmWork& work);
std::optional<SlurmWork> SlurmWorkFromJson(const std::string& text);

// The job that runs a trial, and the job's node.
struct Claim {
  std::string job, node;  // "12_3", "n2"
};

class SlurmWorkFolder {
 public:
  explicit SlurmWorkFolder(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }

  // Makes the folder; one sentence if it cannot be made.
  [[nodiscard]] std::string Make(const SlurmWork& work) const;
  // None where there is no such folder, on this machine.
  std::optional<SlurmWork> Read() const;

  // The trial is this job's from now on; false if a job has it already.
  bool TryToClaim(std::size_t trial, const Claim& claim) const;
  void Release(std::size_t trial) const;
  std::map<std::size_t, Claim> Claims() const;
  // Which of the first `count` trials have a claim: cheaper than Claims.
  std::vector<bool> Claimed(std::size_t count) const;

  void SetProgress(std::size_t trial, std::int64_t virtual_ns) const;
  std::int64_t Progress(std::size_t trial) const;

  std::string RunFolder(std::size_t trial, const std::string& job) const;

  void SetError(const std::string& job, const std::string& sentence) const;
  std::string Error(const std::string& job) const;

 private:
  std::string path_;
};

// The folder of a finished run becomes the trial's result, unless the trial has a result by now.
// Empty on success, also in that case, else one sentence.
[[nodiscard]] std::string PublishRun(const std::string& run, const std::string& result);

// A name that no other call has.
std::string NewWorkName();
// "DIR/slurm/NAME"
std::string WorkFolderIn(const std::string& results, const std::string& name);

// Ends the work that earlier calls have left in the folder of the results, and removes what can be
// removed. The jobs of these calls can do nothing any more. Returns the jobs' names, since the jobs
// may still run.
std::vector<std::string> RetireWorkFolders(const std::string& results);

}  // namespace tcs
