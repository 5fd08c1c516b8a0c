#include "coordinator/os/cpu_register.h"

#include <unistd.h>

#include <algorithm>
#include <map>
#include <random>
#include <utility>

#include "shm/check.h"

namespace tcs {

namespace {

pid_t g_has_one = 0;  // forks of that process have none

constexpr std::int64_t kRow = 1024;  // CPUs, at most
constexpr std::int64_t kMostTickets = std::int64_t{1} << 48;
constexpr std::int64_t kEndOfRows = kRow * kMostTickets - 1;
constexpr std::int64_t kSharers = std::int64_t{1} << 60, kSharersOfOne = std::int64_t{1} << 32;

// Of locks that are no tickets, too.
std::map<std::int64_t, WaitingRun> RunsIn(const std::vector<LockedRange>& ranges) {
  std::map<std::int64_t, WaitingRun> runs;
  for (const LockedRange& range : ranges) {
    const std::int64_t ticket = range.first / kRow;
    if (range.last / kRow != ticket) continue;
    WaitingRun& run = runs[ticket];
    run.ticket = ticket;
    run.pid = range.holder;
    for (std::int64_t at = range.first; at <= range.last; ++at) {
      run.cpus.push_back(static_cast<int>(at % kRow));
    }
  }
  return runs;
}

std::int64_t FirstSharerOf(int cpu) { return kSharers + cpu * kSharersOfOne; }

}  // namespace

CpuRegister::CpuRegister() : locks_("/sys/devices/system/cpu") {
  TCS_CHECK(std::exchange(g_has_one, getpid()) != getpid());
}

CpuRegister::~CpuRegister() { g_has_one = 0; }

void CpuRegister::Queue(const std::vector<int>& cpus) {
  const RangeLocks::Alone alone(locks_);
  const auto others = RunsIn(locks_.OfOthers(0, kEndOfRows));
  ticket_ = others.empty() ? 1 : std::min(others.rbegin()->first + 1, kMostTickets - 1);
  for (const int cpu : cpus) {
    if (cpu < kRow) locks_.Lock(ticket_ * kRow + cpu, ticket_ * kRow + cpu);
  }
}

void CpuRegister::Leave() {
  if (ticket_ >= 0) locks_.Unlock(ticket_ * kRow, ticket_ * kRow + kRow - 1);
  ticket_ = -1;
}

std::vector<WaitingRun> CpuRegister::Ahead() const {
  const std::int64_t end = ticket_ < 0 ? kEndOfRows : ticket_ * kRow - 1;
  std::vector<WaitingRun> ahead;
  for (auto& [ticket, run] : RunsIn(locks_.OfOthers(0, end))) ahead.push_back(std::move(run));
  return ahead;
}

std::size_t CpuRegister::SharersOf(int cpu) const {
  return locks_.OfOthers(FirstSharerOf(cpu), FirstSharerOf(cpu) + kSharersOfOne - 1).size();
}

// Two runs on the same number would count as one: the numbers are drawn.
void CpuRegister::ShareAs(int cpu) {
  std::random_device draws;
  const std::int64_t before = std::exchange(
      shared_at_, FirstSharerOf(cpu) + static_cast<std::int64_t>(draws() % kSharersOfOne));
  locks_.Lock(shared_at_, shared_at_);
  if (before >= 0 && before != shared_at_) locks_.Unlock(before, before);
}

}  // namespace tcs
