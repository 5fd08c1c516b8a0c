// Where several runs at once go. Each run claims a CPU by itself (cpu_claim.h) out of those that
// its process may use; these are the ones that it is to be allowed.
#pragma once

#include <sched.h>

#include <string>
#include <vector>

namespace tcs {

// A CPU that this process may use. Those with the same core share its arithmetic units and caches.
struct CpuPlace {
  int number = 0;
  std::string core;
};

// Those that the calling thread may use, highest first.
std::vector<int> AllowedCpus();

// Lowest first.
std::vector<CpuPlace> CpuPlaces();

// How many runs at once leave the rest of the machine a CPU; at least 1. With `whole_cores` none of
// them shares a core with another, or with the rest: what a run measures is not to depend on that.
int RunsAtOnce(const std::vector<CpuPlace>& cpus, bool whole_cores);

// The CPUs that the `index`th of `runs` runs at once may use. More runs than RunsAtOnce share
// cores; and as many as there are CPUs leave none for the rest of the machine, if somebody asks for
// that.
cpu_set_t PlaceOfRun(const std::vector<CpuPlace>& cpus, bool whole_cores, int runs, int index);

// CPUs of other cores than `cpu`'s, one of each, highest first; at most so many.
std::vector<int> FurtherCpusOf(const std::vector<CpuPlace>& cpus, int cpu, std::size_t most);

// Of this process's own, for a run whose turns are on `home` and that may have `most` in all; 0: as
// many as there are. To be asked before this process is bound to one.
std::vector<int> CpusBesideHome(int home, int most);

}  // namespace tcs
