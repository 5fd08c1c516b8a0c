// Trials on a node have the environment that their caller had, with nothing of Slurm's in it: what
// a program allocates depends on its environment, and under fixed accounting allocations take time.
#pragma once

#include <vector>

#include "coordinator/trials/slurm_folder.h"

namespace tcs {

// The environment of this process.
std::vector<SlurmVariable> ReadEnvironment();

// Makes `environment` that of this process, in the same order. A variable that comes without a
// value, and that this process does not have, stays unset.
void TakeEnvironment(const std::vector<SlurmVariable>& environment);

}  // namespace tcs
