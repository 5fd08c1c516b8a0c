#include "coordinator/processes/counter_reads.h"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <utility>

namespace tcs {

namespace {

// The file that is mapped there, and the place in it; the address where there is none.
std::string PlaceOf(pid_t pid, std::uint64_t address) {
  std::ifstream maps("/proc/" + std::to_string(pid) + "/maps");
  for (std::string line; std::getline(maps, line);) {
    std::uint64_t begin = 0, end = 0, offset = 0;
    if (std::sscanf(line.c_str(), "%lx-%lx %*s %lx", &begin, &end, &offset) != 3) continue;
    const std::size_t path = line.find('/');
    if (address < begin || address >= end || path == std::string::npos) continue;
    return fmt::format("{} (at {:#x})", line.substr(path), address - begin + offset);
  }
  return fmt::format("its memory at {:#x}", address);
}

}  // namespace

void WarnOfCounterReads(RunState& run, const Process& process, std::int64_t places,
                        std::uint64_t first, const char* mend) {
  if (std::exchange(process.client->counter_warned, true)) return;
  const std::string more = places > 1 ? fmt::format(" and {} more places", places - 1) : "";
  run.Warn(fmt::format(
      "{} reads the processor's cycle counter (rdtsc) in {}{}, where tcs cannot replace the "
      "instruction, so what it reads there is the host's time; {}, or say with `rdtsc: host` that "
      "it does no harm",
      process.name, PlaceOf(process.pid, first), more, mend));
}

}  // namespace tcs
