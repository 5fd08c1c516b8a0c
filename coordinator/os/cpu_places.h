// The CPUs for several runs at once. A run claims a CPU by itself (cpu_claim.h) out of the CPUs
// that its process may use; the functions here say which CPUs the process is to be allowed.
#pragma once

#include <sched.h>

#include <string>
#include <vector>

namespace tcs {

// A CPU that this process may use. CPUs with the same core share its arithmetic units and caches.
struct CpuPlace {
  int number = 0;
  std::string core;
};

// The CPUs that the calling thread may use, highest first.
std::vector<int> AllowedCpus();

// The CPUs that this process may use, lowest first.
std::vector<CpuPlace> CpuPlaces();

// How many runs at once leave the rest of the machine a CPU; at least 1. With `whole_cores` no run
// shares a core with another one, or with the rest: a run's measurements are not to depend on that.
int RunsAtOnce(const std::vector<CpuPlace>& cpus, bool whole_cores);

// The CPUs that the `index`th of `runs` runs at once may use. More runs than RunsAtOnce share
// cores; and as many runs as there are CPUs leave none for the rest of the machine, if a user asks
// for that.
cpu_set_t PlaceOfRun(const std::vector<CpuPlace>& cpus, bool whole_cores, int runs, int index);

// CPUs of other cores than `cpu`'s, one of each, highest first; at most so many.
std::vector<int> FurtherCpusOf(const std::vector<CpuPlace>& cpus, int cpu, std::size_t most);

// CPUs of this process's own, for a run whose turns are on `home` and that may have `most` CPUs in
// all; 0: as many as there are. To be asked before this process is bound to one CPU.
std::vector<int> CpusBesideHome(int home, int most);

}  // namespace tcs
