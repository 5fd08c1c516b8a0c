// The texts of the files in which programs read of their computer (computer_file.h), where tcs
// makes them anew: as the kernel writes them, with the values of a robot. Pure: no system calls.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tcs {

// Cores as the kernel lists them: "0-3,6", and as it shows their mask: "4f", in groups of 32.
std::string CoreList(std::uint64_t cores);
std::string CoreMask(std::uint64_t cores, std::size_t of);
constexpr std::uint64_t AllCores(std::size_t of) {
  return of >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << of) - 1;
}

// /proc/cpuinfo of a computer with one processor of so many cores, each like one of the host's.
std::string ProcessorTable(std::string_view of_host, std::size_t cores);

// In the kernel's ticks, of which there are 100 in a second.
constexpr std::int64_t kNsPerTick = 10'000'000;

// /proc/uptime. `busy_ns`: how long each core has computed.
std::string UptimeText(std::int64_t uptime_ns, const std::vector<std::int64_t>& busy_ns);

// /proc/stat.
struct Counters {
  std::int64_t uptime_ns = 0, boot_date_ns = 0;
  std::vector<std::int64_t> busy_ns;
  std::uint64_t switches = 0, processes = 0, running = 0;
};
std::string CountersText(const Counters& counters);

// The values that a robot has for a process or a thread.
struct ProcessFacts {
  std::int64_t user_ns = 0, system_ns = 0, children_ns = 0, started_ns = 0;
  char state = 'S';  // R or S; any other state that the kernel shows is kept
  std::uint32_t core = 0;
  int policy = 0, real_time_priority = 0;
};
// /proc/PID/stat with these in place of the host's.
std::string ProcessCounters(std::string_view of_host, const ProcessFacts& facts);
// /proc/PID/stat of a process that is not in the run, with its start by the robot's clock.
std::string OutsideProcessCounters(std::string_view of_host, std::int64_t later_ticks);
// User and system time as the kernel counts them, in ticks.
struct ProcessTicks {
  std::int64_t user = 0, system = 0;
};
ProcessTicks TicksIn(std::string_view process_counters);

// /proc/PID/status with these in place of the host's.
std::string ProcessStatus(std::string_view of_host, char state, std::uint64_t cores,
                          std::size_t of);

}  // namespace tcs
