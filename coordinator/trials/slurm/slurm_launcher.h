// Runs trials as jobs of a cluster that Slurm manages. The folder of the results is on a file
// system that all nodes share; the jobs find their work there, and leave their results
// (slurm_folder.h).
//
// Jobs take one trial after the other, so that short trials do not each pay for a job's start, and
// a sweep has any number of trials, whatever the largest array is. The launcher looks at the folder
// for what is done, and asks squeue for jobs that are gone. The launcher needs no accounting
// database.
#pragma once

#include <string>
#include <vector>

#include "coordinator/trials/launcher.h"

namespace tcs {

struct SlurmOptions {
  int most_jobs = 0;                 // at once; 0: as many as there are trials, or an array holds
  bool whole_cores = false;          // each job has a core's threads to itself
  bool in_host_network = false;      // trials of one node come one after the other
  std::vector<std::string> options;  // for sbatch
  std::string tcsim;                 // the program, at the same path on all nodes
  std::string version;               // the program's version
};

class SlurmLauncher final : public Launcher {
 public:
  explicit SlurmLauncher(SlurmOptions options) : options_(std::move(options)) {}
  LauncherReport Run(const TrialsWork& work, const LauncherEvents& events) override;

 private:
  const SlurmOptions options_;
};

// Why this machine cannot ask Slurm for anything; empty if it can.
std::string WhyNoSlurm();

// Ends the jobs of these names, which an earlier call has left. Empty on success, else one
// sentence.
[[nodiscard]] std::string CancelJobs(const std::vector<std::string>& names);

}  // namespace tcs
