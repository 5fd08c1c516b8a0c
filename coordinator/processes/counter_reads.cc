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

const char* MendOf(const Process& process, shm::WhereReads where) {
  if (where == shm::WhereReads::kInMadeCode) return "have it compile before it runs";
  return process.is_bare ? "link it dynamically (without -static or -static-pie)"
                         : "build that code with -fasynchronous-unwind-tables";
}

}  // namespace

void WarnOfCounterReads(RunState& run, const Process& process, const CounterReads& reads) {
  if (std::exchange(process.client->counter_warned, true)) return;
  const bool is_made = reads.where == shm::WhereReads::kInMadeCode;
  const std::string place =
      is_made ? "code that it makes as it runs" : PlaceOf(process.pid, reads.first);
  const std::string more =
      reads.places > 1 ? fmt::format(" and {} more places", reads.places - 1) : "";
  run.Warn(fmt::format(
      "{} reads the processor's cycle counter (rdtsc) in {}{}, where tcs cannot replace the "
      "instruction, so what it reads there is the host's time; {}, or say with `rdtsc: host` that "
      "it does no harm",
      process.name, place, more, MendOf(process, reads.where)));
}

}  // namespace tcs
