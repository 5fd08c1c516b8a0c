// A job of `tcsim trials --launcher slurm`, as it runs on a node.
#pragma once

#include <string>

namespace tcs {

// Runs trials of the work in `folder`, one after the other, until each trial has a job that runs
// it, or a few minutes have passed: a job's start costs little of that time, and other users of the
// cluster get a turn. The result is the process's exit status (array_jobs.h). `version` is this
// tcsim's. SIGTERM, as Slurm sends it to a job that it ends, ends the running trial in order and
// without a result.
//
// Trials have the environment of their caller. The calling process must be single-threaded.
int RunSlurmJob(const std::string& folder, const std::string& version);

}  // namespace tcs
