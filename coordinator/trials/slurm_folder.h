// The folder through which the caller of `tcsim trials --launcher slurm` and its jobs speak with
// each other. It is on the file system that the cluster's nodes share, in the folder of the
// results:
//
//   DIR/slurm/NAME/work.json     what is to be run; written before the first job
//   DIR/slurm/NAME/claims/7      symbolic link to "12_3@n2": that job, on that node, runs trial 7
//   DIR/slurm/NAME/progress/7    how far it is, in ns of virtual time
//   DIR/slurm/NAME/runs/7.12_3/  what it has written; renamed to DIR/seed-0008 at the trial's end
//   DIR/slurm/NAME/errors/12_3   why the job can run nothing
//
// A trial has one result, whoever else has run it as well: links and renames are made whole or not
// at all on every file system that clusters share. NAME differs for each call, and is the name of
// its jobs. Once the folder is retired nothing can be renamed out of it any more.
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

// A variable of the caller's environment. Slurm hands those on; the value is here only if Slurm, or
// the shell that it starts a job with, puts another in its place: many a secret is in the others.
struct SlurmVariable {
  std::string name;
  std::optional<std::string> value;
};

struct SlurmWork {
  std::string version;           // of the tcsim that asks for it
  std::string directory;         // where relative paths begin
  std::string results;           // absolute
  bool in_host_network = false;  // no trial can have a network of its own
  std::vector<SlurmVariable> environment;
  std::vector<SlurmTrial> trials;
};

std::string ToJson(const SlurmWork& work);
std::optional<SlurmWork> SlurmWorkFromJson(const std::string& text);

// Who runs a trial.
struct Claim {
  std::string job, node;  // "12_3", "n2"
};

class SlurmWorkFolder {
 public:
  explicit SlurmWorkFolder(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }

  // Makes it; one sentence if it cannot be made.
  [[nodiscard]] std::string Make(const SlurmWork& work) const;
  // None where there is no such folder, on this machine.
  std::optional<SlurmWork> Read() const;

  // The trial is this job's from now on; false if somebody has it.
  bool TryToClaim(std::size_t trial, const Claim& claim) const;
  void Release(std::size_t trial) const;
  std::map<std::size_t, Claim> Claims() const;
  // Which of the first `count` trials have one: cheaper.
  std::vector<bool> Claimed(std::size_t count) const;

  void SetProgress(std::size_t trial, std::int64_t virtual_ns) const;
  std::int64_t Progress(std::size_t trial) const;

  std::string RunFolder(std::size_t trial, const std::string& job) const;

  void SetError(const std::string& job, const std::string& sentence) const;
  std::string Error(const std::string& job) const;

 private:
  std::string path_;
};

// What a finished run wrote becomes the trial's result, unless it has one by now. Empty on success,
// also then, else one sentence.
[[nodiscard]] std::string PublishRun(const std::string& run, const std::string& result);

// A name that no other call has.
std::string NewWorkName();
// "DIR/slurm/NAME"
std::string WorkFolderIn(const std::string& results, const std::string& name);

// Ends what calls before have left in the folder of the results, and removes what can be removed.
// Their jobs can do nothing any more; their names, since they may still run.
std::vector<std::string> RetireWorkFolders(const std::string& results);

}  // namespace tcs
