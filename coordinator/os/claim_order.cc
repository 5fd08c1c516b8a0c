#include "coordinator/os/claim_order.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace tcs {

namespace {

bool Has(const std::vector<int>& cpus, int cpu) {
  return std::find(cpus.begin(), cpus.end(), cpu) != cpus.end();
}

}  // namespace

bool IsAwaited(int cpu, const std::vector<WaitingRun>& runs) {
  return std::any_of(runs.begin(), runs.end(),
                     [cpu](const WaitingRun& run) { return Has(run.cpus, cpu); });
}

std::vector<WaitingRun> RivalsOf(const std::vector<int>& cpus, std::vector<WaitingRun> runs) {
  std::erase_if(runs, [&](const WaitingRun& run) {
    return std::none_of(run.cpus.begin(), run.cpus.end(), [&](int cpu) { return Has(cpus, cpu); });
  });
  return runs;
}

std::vector<int> CpusToClaim(const std::vector<int>& allowed,
                             const std::function<bool(int)>& is_shared, bool leaves_others_some) {
  std::vector<int> cpus = allowed;
  if (cpus.size() < 2) return cpus;
  const int first = cpus.back();
  cpus.pop_back();
  std::stable_partition(cpus.begin(), cpus.end(), [&](int cpu) { return !is_shared(cpu); });
  if (allowed.size() == 2 && leaves_others_some) cpus.push_back(first);
  return cpus;
}

int CpuToShare(const std::vector<int>& allowed, const std::function<bool(int)>& is_claimed,
               const std::function<std::size_t(int)>& sharers) {
  int chosen = 0;
  std::optional<std::pair<bool, std::size_t>> least;
  for (const int cpu : allowed) {
    const std::pair<bool, std::size_t> one{is_claimed(cpu), sharers(cpu)};
    if (least.has_value() && *least <= one) continue;
    least = one;
    chosen = cpu;
  }
  return chosen;
}

std::string PlaceInWords(std::size_t ahead) {
  if (ahead == 0) return "this run is the next one";
  if (ahead == 1) return "1 run is ahead of this one";
  return std::to_string(ahead) + " runs are ahead of this one";
}

}  // namespace tcs
