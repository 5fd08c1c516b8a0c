// The folder that all trials of a plan go to: DIR/trials.json, DIR/[VALUE/]seed-0001/...
#pragma once

#include <string>
#include <vector>

#include "coordinator/os/files.h"
#include "coordinator/trials/record.h"

namespace tcs {

struct ResultFolder {
  FolderLock lock;              // for one `tcsim trials` at a time
  bool has_trials = false;      // of an earlier call, which this call goes on with
  std::string changed_program;  // since those trials; empty if none is known to have changed
  // Jobs of Slurm that an earlier call has left (slurm_folder.h). These jobs can change nothing any
  // more.
  std::vector<std::string> left_jobs;
};

// Makes or takes up the folder `path` for the trials of `record`, and writes its trials.json; with
// `restart` it removes the trials that the folder holds, and nothing else. Empty on success, else
// one sentence, and nothing has changed.
[[nodiscard]] std::string EnterResultFolder(const std::string& path, bool restart,
                                            TrialsRecord record, ResultFolder* folder);

}  // namespace tcs
