// Trials on a node have the environment that their caller had, with nothing of Slurm's in it: what
// a program allocates depends on it, and under fixed accounting that takes time.
#pragma once

#include <vector>

#include "coordinator/trials/slurm_folder.h"

namespace tcs {

// Of this process.
std::vector<SlurmVariable> ReadEnvironment();

// This process's environment is that one from now on, in the same order; what it does not have of
// it stays unset.
void TakeEnvironment(const std::vector<SlurmVariable>& environment);

}  // namespace tcs
