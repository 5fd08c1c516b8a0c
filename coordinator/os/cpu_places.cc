#include "coordinator/os/cpu_places.h"

#include <algorithm>
#include <fstream>

namespace tcs {

namespace {

// A CPU of each core, but not of the first CPU's; the last CPU, if there is no other core.
std::vector<int> OneOfEachCore(const std::vector<CpuPlace>& cpus) {
  std::vector<int> chosen;
  std::vector<std::string> taken{cpus.front().core};
  for (const CpuPlace& cpu : cpus) {
    if (std::find(taken.begin(), taken.end(), cpu.core) != taken.end()) continue;
    taken.push_back(cpu.core);
    chosen.push_back(cpu.number);
  }
  if (chosen.empty() && cpus.size() > 1) chosen.push_back(cpus.back().number);
  return chosen;
}

}  // namespace

std::vector<int> AllowedCpus() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof allowed, &allowed);
  std::vector<int> cpus;
  for (int cpu = CPU_SETSIZE - 1; cpu >= 0; --cpu) {
    if (CPU_ISSET(cpu, &allowed)) cpus.push_back(cpu);
  }
  return cpus;
}

std::vector<CpuPlace> CpuPlaces() {
  std::vector<int> allowed = AllowedCpus();
  std::reverse(allowed.begin(), allowed.end());
  std::vector<CpuPlace> cpus;
  for (const int cpu : allowed) {
    const std::string number = std::to_string(cpu);
    std::ifstream file("/sys/devices/system/cpu/cpu" + number + "/topology/thread_siblings_list");
    std::string siblings;
    cpus.push_back({cpu, file >> siblings ? siblings : number});
  }
  if (cpus.empty()) cpus.push_back({0, "0"});
  return cpus;
}

int RunsAtOnce(const std::vector<CpuPlace>& cpus, bool whole_cores) {
  const std::size_t runs = whole_cores ? OneOfEachCore(cpus).size() : cpus.size() - 1;
  return static_cast<int>(std::max<std::size_t>(1, runs));
}

cpu_set_t PlaceOfRun(const std::vector<CpuPlace>& cpus, bool whole_cores, int runs, int index) {
  cpu_set_t place;
  CPU_ZERO(&place);
  const auto allow = [&place](int cpu) { CPU_SET(static_cast<std::size_t>(cpu), &place); };
  const int first = cpus.front().number;
  // The one run too many has the first CPU to itself.
  if (index + 1 >= static_cast<int>(cpus.size())) {
    allow(first);
  } else if (whole_cores && runs <= RunsAtOnce(cpus, true)) {
    const std::vector<int> chosen = OneOfEachCore(cpus);
    for (const int cpu : chosen) allow(cpu);
    // A claim leaves out the first of several CPUs, but not of two (claim_order.h).
    if (chosen.size() > 1 || cpus.size() == 2) allow(first);
  } else {
    for (const CpuPlace& cpu : cpus) allow(cpu.number);
  }
  return place;
}

std::vector<int> FurtherCpusOf(const std::vector<CpuPlace>& cpus, int cpu, std::size_t most) {
  std::vector<std::string> taken;
  for (const CpuPlace& place : cpus) {
    if (place.number == cpu) taken.push_back(place.core);
  }
  std::vector<int> further;
  for (auto place = cpus.rbegin(); place != cpus.rend() && further.size() < most; ++place) {
    if (std::find(taken.begin(), taken.end(), place->core) != taken.end()) continue;
    taken.push_back(place->core);
    further.push_back(place->number);
  }
  return further;
}

std::vector<int> CpusBesideHome(int home, int most) {
  if (most == 1) return {};
  // `most` is 0: as many as there are.
  return FurtherCpusOf(CpuPlaces(), home, static_cast<std::size_t>(most) - 1);
}

}  // namespace tcs
